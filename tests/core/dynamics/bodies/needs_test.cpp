// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/bodies/needs.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"
#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// The heap without friction and restitution, each sphere turned somehow.
Bodies smooth_heap(int count) {
    Bodies bodies = heap_of_spheres(count);
    for (BodyType& type : bodies.types) type.friction = type.restitution = 0;
    for (BodyId id = 0; id < bodies.size(); ++id)
        if (bodies.is_movable(id)) bodies.rotor[id] = exp({0.1 * id, 0.2, -0.3, 0.4, 1, -0.05});
    return bodies;
}

Needs needs_of(const Bodies& bodies) { return make_simulation(bodies, {}).needs; }

TEST(Needs, AreThoseOfTheBodies) {
    const auto expect = [](const Bodies& bodies, bool friction, bool restitution, bool uneven,
                           bool turning, const char* what) {
        const Needs needs = needs_of(bodies);
        EXPECT_EQ(needs.friction, friction) << what;
        EXPECT_EQ(needs.restitution, restitution) << what;
        EXPECT_EQ(needs.uneven_inertia, uneven) << what;
        EXPECT_EQ(needs.turning, turning) << what;
    };
    const auto with = [](const BodyType& type, const Bivector& omega = {}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5, 0));
        add(bodies, type, Vec4::UnitY(), Vec4::UnitX(), omega);
        return bodies;
    };
    BodyType cube = box_type(Vec4::Ones()), held_cube = cube, held_box = box_type({1, 2, 1, 1});
    cube.friction = held_cube.friction = held_box.friction = 0;
    held_cube.fixed_rotation = held_box.fixed_rotation = true;
    BodyType held_rough = held_box;
    held_rough.friction = 0.5;
    expect(with(sphere_type(1)), false, false, false, false, "the floor's friction meets none");
    expect(with(sphere_type(1), {0, 0, 1e-300, 0, 0, 0}), false, false, false, true, "a spin");
    expect(with(sphere_type(1, 1, 0.1)), true, false, false, true, "friction turns a sphere");
    expect(with(sphere_type(1, 1, 0, 1e-300)), false, true, false, false, "restitution");
    expect(with(cube), false, false, false, true, "its corners turn a cube");
    expect(with(box_type({1, 2, 1, 1})), true, false, true, true, "a box");
    expect(with(held_cube), false, false, false, false, "a cube that cannot turn");
    expect(with(held_rough), true, false, false, false, "a box that cannot turn");
    EXPECT_TRUE(needs_of(with(cube)).internal_edges);
    EXPECT_FALSE(needs_of(with(capsule_type(1, 1))).internal_edges)
        << "a floor that is one plane has none";
    expect(with(held_box, {1, 0, 0, 0, 0, 0}), false, false, false, true, "a driven box");
    BodyType coin = held_cube;
    coin.shape = spherinder(0.5, 0.1);
    EXPECT_FALSE(needs_of(with(coin)).rims) << "a coin that cannot turn";
    coin.fixed_rotation = false;
    EXPECT_TRUE(needs_of(with(coin)).rims);
    EXPECT_FALSE(needs_of(with(cube)).rims);
}

TEST(Needs, RollingFrictionNeedsFrictionAndWhatCanTurn) {
    const auto rolling = [](double floor_friction, double floor_rolling, BodyType type,
                            double friction, double rolling_friction) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, floor_friction));
        bodies.types[0].rolling_friction = floor_rolling;
        type.friction = friction, type.rolling_friction = rolling_friction;
        add(bodies, type, Vec4::UnitY());
        return needs_of(bodies).rolling;
    };
    BodyType held = box_type(Vec4::Ones());
    held.fixed_rotation = true;
    EXPECT_FALSE(rolling(0.5, 0, sphere_type(1), 0.5, 0));
    EXPECT_TRUE(rolling(0.5, 0, sphere_type(1), 0.5, 1e-300));
    EXPECT_TRUE(rolling(0.5, 1e-300, sphere_type(1), 0.5, 0)) << "the larger counts";
    EXPECT_FALSE(rolling(0, 0.1, sphere_type(1), 0.5, 0)) << "that floor has no friction";
    EXPECT_FALSE(rolling(0.5, 0.1, sphere_type(1), 0, 0.1)) << "no friction turns this sphere";
    EXPECT_FALSE(rolling(0.5, 0.1, box_type(Vec4::Ones()), 0, 0.1));
    EXPECT_FALSE(rolling(0.5, 0.1, held, 0.5, 0.1)) << "it cannot turn";
}

/// All steps with every part against those with what was decided: the parts left out add zeros.
TEST(Needs, WhatIsLeftOutWouldChangeNothing) {
    for (const PhysicsSettings& settings : {PhysicsSettings{}, substepped_settings()})
        for (const std::uint32_t coloured_from : {1u, kNoneColoured}) {
            const Bodies bodies = smooth_heap(150);
            const Simulation start = make_simulation(bodies, settings);
            const Needs& needs = start.needs;
            ASSERT_FALSE(needs.friction || needs.restitution || needs.uneven_inertia ||
                         needs.turning || needs.internal_edges);
            Simulation with_all = start;
            with_all.needs = Needs{};
            Stepper decided(start, coloured_from), all(with_all, coloured_from);
            std::uint64_t contacts = 0;
            for (int i = 0; i < 200; ++i) {
                contacts += decided.step(kStep).contacts;
                all.step(kStep);
            }
            EXPECT_GT(contacts, 10000u);
            const Bodies &p = decided.bodies(), &q = all.bodies();
            EXPECT_EQ(p.position, q.position);
            EXPECT_EQ(p.velocity, q.velocity);
            EXPECT_EQ(p.rotor, q.rotor);
            EXPECT_EQ(p.angular_velocity, q.angular_velocity);
            EXPECT_TRUE(same_values(decided.memory(), all.memory()));
        }
}

/// Normals go through a sphere's centre, so that without friction no contact has a torque on it:
/// its spin stays, in every bit, whatever it meets and in either solver.
TEST(Needs, NoContactTurnsASphereWithoutFriction) {
    for (const std::uint32_t coloured_from : {1u, kNoneColoured}) {
        Bodies bodies = smooth_heap(150);
        // Every third one spins, every seventh is a box, which it does not leave in peace.
        for (BodyId id = 7; id < bodies.size(); ++id) {
            if (id % 3 == 0) bodies.angular_velocity[id] = {1, -2, 0.5, 0.1 * id, 3, 1};
            if (id % 7 == 0) give_type(bodies, id, box_type({0.6, 0.5, 0.7, 0.6}, 100));
        }
        Stepper world(make_simulation(bodies, PhysicsSettings{}), coloured_from);
        run(world, 200);
        const Bodies& now = world.bodies();
        int boxes_turned = 0;
        for (BodyId id = 7; id < bodies.size(); ++id) {
            EXPECT_NE(now.velocity[id], bodies.velocity[id]);
            if (id % 7 == 0) {
                boxes_turned += !(now.angular_velocity[id] == bodies.angular_velocity[id]);
                continue;
            }
            EXPECT_EQ(now.angular_velocity[id], bodies.angular_velocity[id]) << id;
            if (id % 3 != 0) {
                EXPECT_EQ(now.rotor[id], bodies.rotor[id]) << id;
            }
        }
        EXPECT_GT(boxes_turned, 10);
    }
}

TEST(Needs, ABodyThatIsNoRotationIsNamedWhereNothingTurns) {
    Bodies bodies = smooth_heap(3);
    bodies.rotor[8].b.xz = std::numeric_limits<double>::quiet_NaN();
    Stepper world(bodies, PhysicsSettings{});
    try {
        world.step(kStep);
        ADD_FAILURE() << "nothing thrown";
    } catch (const LeftFiniteRange& error) {
        EXPECT_EQ(error.body, 8u);
    }
}

}  // namespace
}  // namespace tesserae
