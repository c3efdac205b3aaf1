// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/sleeping.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

PhysicsSettings sleepy() {
    PhysicsSettings settings;
    settings.sleeping = true;
    return settings;
}

/// A floor, a stack of three boxes, and another far away.
Bodies two_stacks() {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (const double x : {0.0, 10.0})
        for (int i = 0; i < 3; ++i) add(bodies, box_type(Vec4::Ones(), 10), {x, 0.5 + i, 0, 0});
    return bodies;
}

TEST(Sleeping, StacksAtRestFallAsleepAndStayWhereTheyAre) {
    Stepper world(two_stacks(), sleepy());
    run(world, 240);
    const std::vector<BodyId> expected{kAwake, 1, 1, 1, 4, 4, 4};
    EXPECT_EQ(world.memory().asleep, expected);
    const Bodies before = world.bodies();
    const std::size_t impulses = world.memory().impulses.size();
    const StepReport report = world.step(kStep);
    EXPECT_TRUE(same_bits(world.bodies(), before));
    EXPECT_EQ(world.memory().impulses.size(), impulses);
    EXPECT_EQ(report.asleep, 6u);
    EXPECT_EQ(report.contacts, impulses);
    for (BodyId id = 1; id < 7; ++id) EXPECT_EQ(before.velocity[id], Vec4::Zero());
}

TEST(Sleeping, IsOffByDefault) {
    Stepper world(two_stacks(), PhysicsSettings{});
    run(world, 240);
    EXPECT_TRUE(world.memory().asleep.empty());
    EXPECT_EQ(world.step(kStep).asleep, 0u);
}

TEST(Sleeping, AHitWakesTheWholeStackAndNoOther) {
    Bodies bodies = two_stacks();
    // Arrives at the lowest box of the first stack after some 1.2 s, from the fourth direction.
    add(bodies, sphere_type(0.3, 5, 0), {0, 0.5, 0, -7.2}, {0, 0, 0, 5});
    PhysicsSettings settings = sleepy();
    settings.gravity = {0, -1e-3, 0, 0};  // hardly falls on its way
    Stepper world(bodies, settings), sleepless(bodies, [&] {
        PhysicsSettings other = settings;
        other.sleeping = false;
        return other;
    }());
    bool slept = false;
    for (int i = 0; i < 360; ++i) {
        world.step(kStep);
        sleepless.step(kStep);
        slept = slept || world.memory().asleep[3] == 1;
    }
    EXPECT_TRUE(slept);
    EXPECT_EQ(world.memory().asleep,
              (std::vector<BodyId>{kAwake, kAwake, kAwake, kAwake, 4, 4, 4, kAwake}));
    // Pushed on in the step of the hit as if it had never slept, but for what it crept meanwhile.
    for (const BodyId id : {1u, 7u}) {
        EXPECT_LT((world.bodies().velocity[id] - sleepless.bodies().velocity[id]).norm(), 1e-3);
        EXPECT_LT((world.bodies().position[id] - sleepless.bodies().position[id]).norm(), 1e-3);
    }
    EXPECT_GT(world.bodies().velocity[1][3], 0.1);
}

TEST(Sleeping, NothingSleepsOnWhatIsDriven) {
    Bodies bodies;
    BodyType belt = box_type({40, 1, 40, 40});
    belt.friction = 0.5;
    belt.fixed_position = belt.fixed_rotation = true;
    add(bodies, belt, {0, -0.5, 0, 0}, {1e-4, 0, 0, 0});
    add(bodies, box_type(Vec4::Ones(), 10), {0, 0.5, 0, 0});
    Stepper world(bodies, sleepy());
    run(world, 480);
    EXPECT_EQ(world.memory().asleep[1], kAwake);
    EXPECT_NEAR(world.bodies().velocity[1][0], 1e-4, 1e-9);
}

TEST(Sleeping, AClosingWallWakesWhatItTouches) {
    Bodies bodies = two_stacks();
    BodyType wall = box_type({1, 4, 4, 4});
    wall.fixed_position = wall.fixed_rotation = true;
    add(bodies, wall, {-3, 2.5, 0, 0}, {1, 0, 0, 0});
    Stepper world(bodies, sleepy());
    run(world, 600);  // the wall's face comes from -2.5 and would be at 0, the boxes' were at -0.5
    for (BodyId id = 1; id <= 3; ++id) EXPECT_GT(world.bodies().position[id][0], 0.45) << id;
    EXPECT_EQ(world.memory().asleep[4], 4u);
}

TEST(Sleeping, ABodyAtItsHighestPointStaysAwake) {
    Bodies bodies;
    add(bodies, sphere_type(0.5), Vec4::Zero(), {0, 2, 0, 0});
    Stepper world(bodies, sleepy());
    for (int i = 0; i < 240; ++i) {
        world.step(kStep);
        ASSERT_EQ(world.memory().asleep[0], kAwake);
    }
    EXPECT_NEAR(world.bodies().position[0][1], 2 - 5, 1e-12);
}

/// A body much slower for its size than what is still.
TEST(Sleeping, WhatNothingCarriesFliesOn) {
    PhysicsSettings weightless = sleepy();
    weightless.gravity.setZero();
    Bodies bodies;
    add(bodies, sphere_type(10), Vec4::Zero(), {0.05, 0, 0, 0});
    add(bodies, box_type(Vec4::Constant(10)), {0, 100, 0, 0}, Vec4::Zero(), {0, 1e-3, 0, 0, 0, 0});
    for (const double x : {0.0, 20.0})  // two that touch, and drift together
        add(bodies, sphere_type(10), {x, -100, 0, 0}, {0, 0, 0.05, 0});
    add(bodies, sphere_type(10), {100, 0, 0, 0});  // stands
    Stepper world(bodies, weightless);
    run(world, 480);
    const Bodies& now = world.bodies();
    EXPECT_EQ(world.memory().asleep, (std::vector<BodyId>{kAwake, kAwake, kAwake, kAwake, 4}));
    EXPECT_NEAR(now.position[0][0], 0.05 * 2, 1e-12);
    EXPECT_NEAR(now.angular_velocity[1].xz, 1e-3, 1e-15);
    for (const BodyId id : {2u, 3u}) EXPECT_NEAR(now.position[id][2], 0.05 * 2, 1e-12);
}

/// Balls on a slope, which only rolling friction holds: those that a hit wakes are held as before.
TEST(Sleeping, KeepsWhatHoldsRolling) {
    Bodies bodies;
    add(bodies, plane_type(Vec4(0.08, 1, 0, 0).normalized(), 0, 0.5));
    bodies.types[0].rolling_friction = 0.05;
    const Vec4 up = 0.5 * Vec4(0.08, 1, 0, 0).normalized();
    for (int i = 0; i < 6; ++i) add(bodies, sphere_type(0.5, 1, 0.5), up + Vec4(0, 0, 3 * i, 0));
    // Falls on the fourth after 1.2 s.
    add(bodies, sphere_type(0.2, 0.1, 0.5), {0.1, 8.2, 9, 0.05});
    Stepper world(bodies, sleepy());
    run(world, 240);
    const StepMemory before = world.memory();
    ASSERT_EQ(before.asleep[4], 4u);
    ASSERT_EQ(before.angular_impulses.size(), 6u);
    // R m g sin of a sub-step, about the point of contact.
    const double torque = 0.5 * 10 * 0.08 / std::sqrt(1 + 0.08 * 0.08);
    for (const Bivector& held : before.angular_impulses)
        EXPECT_NEAR(norm(held), torque * kStep, 1e-4 * torque * kStep);
    run(world, 120);
    const StepMemory& after = world.memory();
    EXPECT_EQ(after.asleep[4], kAwake);
    ASSERT_EQ(after.angular_impulses.size(), after.impulses.size());
    for (const std::size_t i : {0, 1, 2, 4, 5}) {
        EXPECT_EQ(after.impulses[i].b, i + 1);
        EXPECT_EQ(after.angular_impulses[i], before.angular_impulses[i]) << i;
        EXPECT_TRUE(world.bodies().velocity[i + 1].isZero());
    }
}

TEST(Sleeping, ContinuesBitForBitFromItsBodiesAndMemory) {
    Bodies bodies = two_stacks();
    for (BodyId id = 1; id < bodies.size(); ++id)  // of uneven inertia, which turns with them
        bodies.types[bodies.type[id]].shape = Hyperbox{{1.2, 1, 0.8, 1}};
    add(bodies, sphere_type(0.3, 5, 0.2), {0.1, 14, 0.1, 0.1});
    for (const double rolling_friction : {0.0, 0.02})
        for (const int before : {60, 200, 380}) {
            for (BodyType& type : bodies.types) type.rolling_friction = rolling_friction;
            Stepper world(bodies, sleepy());
            run(world, before);
            Stepper resumed(world.bodies(), sleepy());
            resumed.memory() = world.memory();
            run(world, 200);
            run(resumed, 200);
            EXPECT_TRUE(same_bits(world.bodies(), resumed.bodies())) << before;
            EXPECT_TRUE(same_values(world.memory(), resumed.memory())) << before;
        }
}

/// It tips by so little that it is slower than what lies still for the first second or two.
TEST(Sleeping, WhatBeginsToTipFalls) {
    for (const double side : {0.2, 1.0, 2.0})
        for (const double beyond : {0.002, 0.004, 0.01}) {
            const double height = 6 * side, lean = std::atan(side / height) + beyond;
            Bodies bodies;
            add(bodies, plane_type(Vec4::UnitY(), 0, 0.9));
            BodyType tower = box_type({side, height, side, side});
            tower.friction = 0.9;
            const Rotor turn = exp(Bivector{0.5 * lean, 0, 0, 0, 0, 0});
            const Vec4 half = 0.5 * Vec4(side, height, side, side);
            const double y = to_matrix(turn).row(1).cwiseAbs().dot(half);
            add(bodies, tower, y * Vec4::UnitY(), Vec4::Zero(), {}, turn);
            Stepper world(bodies, sleepy());
            run(world, 12 * 240);
            EXPECT_LT(world.bodies().position[1][1], 0.6 * side) << side << ' ' << beyond;
        }
}

TEST(Sleeping, ABallOnAGentleSlopeBeginsToRoll) {
    for (const double radius : {0.02, 0.5, 5.0})
        for (const double slope : {1e-3, 1e-2}) {
            PhysicsSettings settings = sleepy();
            settings.gravity = {10 * std::sin(slope), -10 * std::cos(slope), 0, 0};
            Bodies bodies;
            add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
            add(bodies, sphere_type(radius, 1, 0.5), radius * Vec4::UnitY());
            Stepper world(bodies, settings);
            run(world, 960);
            EXPECT_NEAR(world.bodies().velocity[1][0], 0.75 * 10 * std::sin(slope) * 4,
                        1e-6 + 1e-6 * radius)
                << radius << ' ' << slope;
        }
}

}  // namespace
}  // namespace tesserae
