// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string_view>
#include <vector>

#include "core/contact/find_contacts.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

using namespace testing;

BodyType type_of(const Shape& shape) {
    BodyType type;
    type.shape = shape;
    return type;
}

/// Turns one axis down (-y), or up.
Rotor axis_down(int axis, double sign = 1) {
    Mat4 map = Mat4::Identity();
    if (axis != 1) {
        map.col(axis) = -sign * Vec4::UnitY();
        map.col(1) = sign * Vec4::Unit(axis);
    } else if (sign > 0) {
        map.col(1) = -Vec4::UnitY();
        map.col(0) = -Vec4::UnitX();
    }
    return to_rotor(map);
}

struct Standing {
    const char* name;
    Shape shape;
    int axis;  ///< that is down
};
/// Every flat or ruled piece of each.
std::vector<Standing> ways_to_stand() {
    const Spherinder ball = spherinder(0.5, 0.8);
    const Cubinder disc = cubinder(0.5, {0.7, 0.9});
    const Duocylinder discs = duocylinder({0.5, 0.4});
    return {{"spherinder's end", ball, 1},         {"spherinder's side", ball, 0},
            {"cubinder's disc", disc, 2},          {"cubinder's other disc", disc, 3},
            {"cubinder's side", disc, 0},          {"duocylinder's first side", discs, 0},
            {"duocylinder's other side", discs, 3}};
}

double height_of(const Standing& s) {
    return std::visit(
        [&](const auto& shape) { return half_extent_along(shape, Vec4::Unit(s.axis)); }, s.shape);
}

/// Bodies that stand one upon the other, some seconds later.
/// @param stacked   so many
void expect_rest(const Standing& s, const BodyType& floor, const Vec4& floor_at, int stacked) {
    Bodies bodies;
    add(bodies, floor, floor_at);
    const double half = height_of(s);
    for (int i = 0; i < stacked; ++i)
        add(bodies, type_of(s.shape), {0.01 * i, (2 * i + 1) * half, 0.02 * i, 0}, Vec4::Zero(), {},
            axis_down(s.axis, i % 2 ? 1 : -1));
    PhysicsSettings settings;
    settings.sleeping = false;
    Stepper world(bodies, settings);
    run(world, 480);
    for (BodyId id = 1; id < bodies.size(); ++id) {
        const Bodies& now = world.bodies();
        EXPECT_LT((now.position[id] - bodies.position[id]).norm(), 0.004 * stacked) << s.name;
        EXPECT_LT((to_matrix(now.rotor[id]) - to_matrix(bodies.rotor[id])).norm(), 0.01) << s.name;
        // Well below the tolerance at which sweeps end.
        EXPECT_LT(now.velocity[id].norm() + norm(now.angular_velocity[id]),
                  0.2 * settings.tolerance * stacked)
            << s.name;
    }
}

TEST(RoundProducts, StandOnAPlane) {
    for (const Standing& s : ways_to_stand())
        expect_rest(s, plane_type(Vec4::UnitY(), 0, 0.5), Vec4::Zero(), 1);
}

TEST(RoundProducts, StandOnABox) {
    BodyType floor;
    floor.shape = Hyperbox{{4, 1, 4, 4}};
    floor.fixed_position = floor.fixed_rotation = true;
    for (const Standing& s : ways_to_stand()) expect_rest(s, floor, {0.3, -0.5, 0.2, 0.1}, 1);
}

TEST(RoundProducts, StandOnOneAnother) {
    for (const Standing& s : ways_to_stand()) {
        // On round sides they would roll off.
        const bool is_flat = std::string_view(s.name).find("side") == std::string_view::npos;
        if (is_flat) expect_rest(s, plane_type(Vec4::UnitY(), 0, 0.5), Vec4::Zero(), 3);
    }
}

/// A log on three that lie side by side, all along z: on its round side, in the hollow.
TEST(RoundProducts, LieSideBySide) {
    Bodies bodies;
    BodyType log = type_of(spherinder(0.5, 2));
    const Rotor along_z = exp(Bivector{0, 0, 0, pi / 4, 0, 0});
    const Vec4 corners[] = {{0.6, 0, 0, 0}, {-0.3, 0, 0, 0.52}, {-0.3, 0, 0, -0.52}};
    log.fixed_position = log.fixed_rotation = true;
    for (const Vec4& at : corners) add(bodies, log, at, Vec4::Zero(), {}, along_z);
    log.fixed_position = log.fixed_rotation = false;
    add(bodies, log, {0, std::sqrt(1 - 0.36), 0.3, 0}, Vec4::Zero(), {}, along_z);
    Stepper world(bodies, PhysicsSettings{});
    run(world, 480);
    EXPECT_LT((world.bodies().position[3] - bodies.position[3]).norm(), 2e-3);
    EXPECT_LT(world.bodies().velocity[3].norm() + norm(world.bodies().angular_velocity[3]), 1e-5);
    // Two points with each: from where both have begun to where one ends.
    const Bodies& now = world.bodies();
    for (BodyId id = 0; id < 3; ++id) {
        std::vector<Contact> list;
        find_contacts(id, log.shape, {now.position[id], now.rotor[id]}, 3, log.shape,
                      {now.position[3], now.rotor[3]}, 0.01, list);
        ASSERT_EQ(list.size(), 2u);
        EXPECT_NEAR(std::min(list[0].point[2], list[1].point[2]), -0.7, 1e-3);
        EXPECT_NEAR(std::max(list[0].point[2], list[1].point[2]), 1, 1e-3);
    }
}

/// Pushed along each horizontal axis without spin: a body that can roll that way ends with
/// v / (1 + I / M r^2), I the inertia of the plane in which it turns; what cannot stops.
TEST(RoundProducts, RollAsFreelyAsTheyAreRound) {
    const auto expect_rolls = [](const Standing& s, int freedoms, double inertia) {
        int rolled = 0;
        for (const int along : {0, 2, 3}) {
            Bodies bodies;
            add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
            const Vec4 push = Vec4::Unit(along);
            add(bodies, type_of(s.shape), height_of(s) * Vec4::UnitY(), push, {},
                axis_down(s.axis));
            Stepper world(bodies, PhysicsSettings{});
            run(world, 480);
            const Vec4 v = world.bodies().velocity[1];
            EXPECT_LT((v - v[along] * push).norm(), 1e-6) << s.name;
            const bool rolls = v.norm() > 0.01;
            rolled += rolls;
            // It stops slipping within a step.
            EXPECT_NEAR(v[along], rolls ? 1 / (1 + inertia) : 0, rolls ? 2e-3 : 1e-6)
                << s.name << " along " << along;
            // What slips comes v^2 / (2 friction g) far.
            if (!rolls) {
                EXPECT_NEAR(world.bodies().position[1][along], 1 / (2 * 0.5 * 9.81), 3e-3)
                    << s.name;
            }
        }
        EXPECT_EQ(rolled, freedoms) << s.name;
    };
    expect_rolls({"hypersphere", Hypersphere{0.5}, 0}, 3, 1.0 / 3);
    for (const Standing& s : ways_to_stand()) {
        const std::string_view name = s.name;
        if (name.find("side") == std::string_view::npos)
            expect_rolls(s, 0, 0);
        else
            expect_rolls(s, name.starts_with("sph") ? 2 : 1, name.starts_with("sph") ? 0.4 : 0.5);
    }
}

/// A log, a hair out of line, between a fixed one and a wall: their ends' corners are points of the
/// pair however deep they have sunk in. By the core's level an end was nearer than the round side:
/// one point was left, at another corner in each step, and logs sank into each other by a third.
TEST(RoundProducts, ThatLieBetweenOthersAHairOutOfLineDoNotSinkIn) {
    std::mt19937_64 random(7);
    const auto uniform = [&](double most) {
        return std::uniform_real_distribution<>(-most, most)(random);
    };
    const double radius = 0.25;
    const Rotor along_z = exp(Bivector{0, 0, 0, pi / 4, 0, 0});
    for (const auto& [shape, turn] : {std::pair{Shape(cubinder(radius, {2, 2})), Rotor{}},
                                      {Shape(duocylinder({radius, 1})), Rotor{}},
                                      {Shape(spherinder(radius, 2)), along_z}})
        for (int i = 0; i < 10; ++i) {
            BodyType log = type_of(shape);
            log.friction = 0.5;
            BodyType fixed = log;
            fixed.fixed_position = fixed.fixed_rotation = true;
            const double x = radius * (1 + 0.5 * uniform(1));
            const Bivector lean = {0, uniform(3e-3), uniform(3e-3), uniform(3e-3), uniform(3e-3),
                                   0};
            Bodies bodies;
            add(bodies, fixed, Vec4::Zero(), Vec4::Zero(), {}, turn);
            add(bodies, log, {x, std::sqrt(4 * radius * radius - x * x), 0, 0}, Vec4::Zero(), {},
                exp(lean) * turn);
            add(bodies, plane_type(-Vec4::UnitX(), -x - radius, 0.5));
            Stepper world(bodies, PhysicsSettings{});
            double deepest = 0;
            for (int step = 0; step < 480; ++step) {
                const double now = world.step(kStep).penetration;
                if (step > 240) deepest = std::max(deepest, now);
            }
            EXPECT_LT(deepest, 0.01 * radius) << shape.index() << " " << i;
            // Balls times segments roll off each other along w.
            if (std::holds_alternative<Spherinder>(shape)) continue;
            EXPECT_LT(world.bodies().velocity[1].norm(), 1e-3) << shape.index() << " " << i;
        }
}

/// Discs that land aslant, spinning, and wobble down: the point that touches runs round the rim
/// faster than it is found again.
TEST(RoundProducts, ThatWobbleDownDoNotSinkIn) {
    std::mt19937_64 random(3);
    const auto uniform = [&](double least, double most) {
        return std::uniform_real_distribution<>(least, most)(random);
    };
    for (int i = 0; i < 40; ++i) {
        const double radius = 0.01 * std::pow(30, uniform(0, 1));
        const double thin = radius * uniform(0.1, 0.5);
        BodyType type =
            type_of(i % 2 == 0 ? Shape(spherinder(radius, thin))
                               : Shape(cubinder(radius, {thin, uniform(1, 2) * radius})));
        type.friction = 0.5;
        const Bivector lean{uniform(-0.4, 0.4), uniform(-0.4, 0.4), uniform(-0.4, 0.4),
                            uniform(-0.4, 0.4), uniform(-0.4, 0.4), uniform(-0.4, 0.4)};
        const Bivector spin{uniform(-3, 3), uniform(-3, 3), uniform(-3, 3),
                            uniform(-3, 3), uniform(-3, 3), uniform(-3, 3)};
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        add(bodies, type, {0, 4 * radius, 0, 0}, {uniform(0, 0.5), 0, 0, 0}, spin,
            exp(lean) * axis_down(i % 2 == 0 ? 1 : 2));
        Stepper world(bodies, PhysicsSettings{});
        double deepest = 0;
        for (int step = 0; step < 480; ++step)
            deepest = std::max(deepest, world.step(kStep).penetration);
        EXPECT_LT(deepest, 0.3 * thin) << i << ' ' << radius << ' ' << thin;
    }
}

/// Narrower than what it lies on, where only its own edges end what both share: one point bore it,
/// at another corner each step, between which it sank in (by 0.1 m in a second).
TEST(RoundProducts, APlankThatRocksOnACubinderDoesNotSinkIn) {
    for (const double lean : {0.0, 0.02, 0.1})
        for (const bool fixed : {true, false}) {
            Bodies bodies;
            BodyType log = type_of(cubinder(0.1, {0.37, 0.37}));
            log.friction = 1;
            log.mass = 1000;
            log.fixed_position = log.fixed_rotation = fixed;
            if (!fixed) add(bodies, plane_type(Vec4::UnitY(), -0.1, 1));
            add(bodies, log);
            BodyType plank = box_type({0.4, 0.02, 0.2, 0.2});
            plank.friction = 1;
            // Rolled aside by as much as it leans.
            const Rotor turn = exp(Bivector{-0.5 * lean, 0, 0, 0, 0, 0});
            const Vec4 up = rotate(turn, Vec4::UnitY()), along = rotate(turn, Vec4::UnitX());
            add(bodies, plank, 0.11 * up - 0.1 * lean * along, Vec4::Zero(), {}, turn);
            Stepper world(bodies, PhysicsSettings{});
            double deepest = 0;
            for (int i = 0; i < 480; ++i)
                deepest = std::max(deepest, world.step(kStep).penetration);
            EXPECT_LT(deepest, 5e-4) << lean << (fixed ? " fixed" : " free");
            EXPECT_GT(world.bodies().position.back()[1], 0.105) << lean;
        }
}

}  // namespace
}  // namespace tesserae
