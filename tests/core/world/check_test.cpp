// SPDX-License-Identifier: Apache-2.0
#include "core/world/check.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "core/error.hpp"
#include "tests/core/world/random_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string error_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// A World refuses it, says where, and is as before.
void expect_refused(const std::string& place, const std::function<void(World&)>& call) {
    World world;
    world.add(sphere_type(1));
    world.add(plane_type(Vec4::UnitY(), -5));
    const std::string before = world.save();
    const std::string error = error_of([&] { call(world); });
    EXPECT_NE(error.find(place), std::string::npos) << place << ": " << error;
    EXPECT_EQ(world.save(), before) << place;
}

TEST(Check, EveryNumberOfATypeHasItsRange) {
    const auto type = [](const std::string& place, auto member,
                         std::initializer_list<double> wrong) {
        for (const double value : wrong)
            expect_refused(place, [&](World& world) {
                BodyType body = sphere_type(1);
                body.*member = value;
                world.add(body);
            });
    };
    type("mass", &BodyType::mass, {kNaN, 0, -1, kInfinity, 1e61});
    type("friction", &BodyType::friction, {kNaN, -1, kInfinity});
    type("rolling_friction", &BodyType::rolling_friction, {kNaN, -1, 1e16});
    type("restitution", &BodyType::restitution, {kNaN, -0.1, 1.1});
    type("gravity_scale", &BodyType::gravity_scale, {kNaN, kInfinity});
    type("damping", &BodyType::damping, {kNaN, -1});
    expect_refused("group = 64", [](World& world) {
        BodyType body = sphere_type(1);
        body.group = 64;
        world.add(body);
    });
}

TEST(Check, WhatIsUnboundedHasNothingThatMovesIt) {
    const auto plane = [](const std::string& place, auto member, double value) {
        expect_refused(place, [&](World& world) {
            BodyType body = plane_type(Vec4::UnitY(), 0);
            body.*member = value;
            world.add(body);
        });
    };
    plane("mass = 3: a hyperplane never moves", &BodyType::mass, 3);
    plane("mass = nan", &BodyType::mass, kNaN);
    plane("gravity_scale = 0", &BodyType::gravity_scale, 0);
    plane("damping = 0.5", &BodyType::damping, 0.5);
    // What touches it is told these, and it is fixed indeed.
    World world;
    BodyType body = plane_type(Vec4::UnitY(), 0);
    body.friction = 0.1, body.restitution = 0.2, body.rolling_friction = 0.3, body.group = 4;
    body.fixed_position = body.fixed_rotation = true;
    EXPECT_EQ(error_of([&] { world.add(body); }), "");
}

TEST(Check, ManyBodiesAreAddedOrNone) {
    expect_refused("row 1: position.w = nan", [](World& world) {
        const BodyState states[] = {{}, {{0, 0, 0, kNaN}, {}, Vec4::Zero(), {}}, {}};
        world.add_many(sphere_type(1), states);
    });
    expect_refused("row 0: state: a hyperplane stands still", [](World& world) {
        const BodyState states[] = {{{1, 0, 0, 0}, {}, Vec4::Zero(), {}}};
        world.add_many(plane_type(Vec4::UnitY(), 0), states);
    });
    expect_refused("restitution = 2", [](World& world) {
        BodyType body = sphere_type(1);
        body.restitution = 2;
        world.add_many(body, {});
    });
}

TEST(Check, EveryParameterOfAShapeHasItsRule) {
    const auto shape = [](const std::string& place, const Shape& wrong) {
        expect_refused(place, [&](World& world) {
            BodyType body;
            body.shape = wrong;
            world.add(body);
        });
        EXPECT_NE(error_of([&] { World().overlapping(wrong, Vec4::Zero()); }), "") << place;
    };
    shape("hypersphere: radius = 0", Hypersphere{0});
    shape("hypersphere: radius = nan", Hypersphere{kNaN});
    shape("hypercapsule: height = -1", Hypercapsule{1, -1});
    shape("hyperbox: size[2] = inf", Hyperbox{{1, 1, kInfinity, 1}});
    shape("hyperplane: normal: expected a direction", Hyperplane{Vec4::Zero(), 1});
    shape("hyperplane: offset = nan", Hyperplane{Vec4::UnitX(), kNaN});
    Duocylinder round;
    round.radii[1] = 0;
    shape("duocylinder: radii[1] = 0", round);
    Duoprism prism;
    prism.polygons = {4, 2};
    shape("duoprism: polygons = 2", prism);
    prism.polygons = {400, 400};
    shape("vertices", prism);
    Polychoron cell;
    cell.radius = 1e16;
    shape("polychoron: radius = 1e+16", cell);
    cell.regular = RegularPolychoron::kNone;
    cell.vertices = {{1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}, {4, 0, 0, 0}, {5, 0, 0, 0}};
    shape("", cell);
    cell.vertices[3][2] = kNaN;
    shape("polychoron: vertices[3][2] = nan", cell);
    cell.regular = static_cast<RegularPolychoron>(40);
    shape("polychoron: regular = 40", cell);
}

TEST(Check, EveryNumberOfAStateIsFiniteAndARotorARotation) {
    const auto state = [](const std::string& place, const BodyState& wrong) {
        expect_refused(place, [&](World& world) { world.set_state(0, wrong); });
        expect_refused(place, [&](World& world) { world.add(sphere_type(1), wrong); });
    };
    state("position.w = nan", {{0, 0, 0, kNaN}, {}, Vec4::Zero(), {}});
    state("position.x = 1e+16", {{1e16, 0, 0, 0}, {}, Vec4::Zero(), {}});
    state("velocity.y = -inf", {Vec4::Zero(), {}, {0, -kInfinity, 0, 0}, {}});
    state("angular_velocity.zw = nan", {Vec4::Zero(), {}, Vec4::Zero(), {0, 0, 0, 0, 0, kNaN}});
    state("rotor.xy = nan", {Vec4::Zero(), {1, {kNaN, 0, 0, 0, 0, 0}, 0}, Vec4::Zero(), {}});
    state("rotor: is no rotation", {Vec4::Zero(), {2, {}, 0}, Vec4::Zero(), {}});
    state("rotor: is no rotation",
          {Vec4::Zero(), {std::sqrt(0.5), {}, std::sqrt(0.5)}, Vec4::Zero(), {}});
    expect_refused("stands still at the origin", [](World& world) {
        world.set_state(1, {{1, 0, 0, 0}, {}, Vec4::Zero(), {}});
    });
}

TEST(Check, PushesTimesAndSettingsHaveTheirRanges) {
    expect_refused("impulse.x = nan", [](World& w) {
        w.apply_impulse(0, {kNaN, 0, 0, 0}, Vec4::Zero());
    });
    expect_refused("point.z = inf", [](World& w) {
        w.apply_force(0, Vec4::UnitX(), {0, 0, kInfinity, 0});
    });
    expect_refused("force.y = nan", [](World& w) {
        w.apply_force(0, {0, kNaN, 0, 0}, Vec4::Zero());
    });
    expect_refused("torque.xz = nan", [](World& w) { w.apply_torque(0, {0, kNaN, 0, 0, 0, 0}); });
    expect_refused("impulse.xy = nan", [](World& w) {
        w.apply_angular_impulse(0, {kNaN, 0, 0, 0, 0, 0});
    });
    expect_refused("gravity.y = nan", [](World& w) { w.set_gravity({0, kNaN, 0, 0}); });
    expect_refused("time step", [](World& w) { w.step(0); });
    expect_refused("time step", [](World& w) { w.step(kNaN); });
    expect_refused("body 9: was never added", [](World& w) { w.wake(9); });
    const auto settings = [](const std::string& place, auto member, auto value) {
        PhysicsSettings wrong;
        wrong.*member = value;
        EXPECT_NE(error_of([&] { World{wrong}; }).find(place), std::string::npos) << place;
    };
    settings("steps_per_second = 0", &PhysicsSettings::steps_per_second, 0.0);
    settings("substeps = 0", &PhysicsSettings::substeps, 0);
    settings("iterations = 100000", &PhysicsSettings::iterations, 100000);
    settings("tolerance = nan", &PhysicsSettings::tolerance, kNaN);
    settings("integrator = 7", &PhysicsSettings::integrator, static_cast<RotationIntegrator>(7));
    World world;
    const BodyId ball = world.add(sphere_type(1));
    world.remove(ball);
    EXPECT_EQ(error_of([&] { world.remove(ball); }),
              "body 0: was removed; expected one that the world has");
}

}  // namespace
}  // namespace tesserae
