// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// In half-sizes of 0.5 m a second, relative to each other.
TEST(Substeps, LeaveBodiesThatStartInsideEachOtherNoMoreThanTheLargestPush) {
    for (const double depth : {0.1, 0.5, 0.99}) {
        Bodies bodies;
        add(bodies, sphere_type(0.5), Vec4::Zero());
        add(bodies, sphere_type(0.5), (1 - depth) * Vec4(1, 2, 0, 2) / 3);
        PhysicsSettings settings = substepped_settings();
        settings.gravity.setZero();
        Stepper world(bodies, settings);
        for (int i = 0; i < 480; ++i) world.step(1.0 / 240);
        const Bodies& end = world.bodies();
        EXPECT_LE((end.velocity[1] - end.velocity[0]).norm(),
                  kFastestCorrection * 0.5 * (1 + 1e-12));
        EXPECT_GT((end.position[1] - end.position[0]).norm(), 1) << depth;
    }
}

/// e = 0.8 from 1 m: 0.64 m, exact in energy whatever the sub-steps.
TEST(Substeps, ABallBouncesToTheSameHeightWithAnyNumberOfThem) {
    for (const int substeps : {1, 4, 7}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0, 0.8));
        add(bodies, sphere_type(0.5, 2, 0, 0.8), {0, 1.5, 0, 0});
        PhysicsSettings settings = substepped_settings();
        settings.substeps = substeps;
        Stepper world(bodies, settings);
        while (world.bodies().velocity[1][1] <= 0) world.step(1.0 / 240);
        const double v = world.bodies().velocity[1][1], y = world.bodies().position[1][1] - 0.5;
        EXPECT_NEAR(y + v * v / 20, 0.64, 1e-12) << substeps;
    }
}

/// 3/4 of the speed once it rolls: core/FORMULAS.md 6.
TEST(Substeps, ABallSlidesAndRollsExactly) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.3));
    add(bodies, sphere_type(0.5, 2, 0.3), {0, 0.5, 0, 0}, {0, 0, 2.16, 2.88});
    Stepper world(bodies, substepped_settings());
    for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
    EXPECT_LT((world.bodies().velocity[1] - Vec4(0, 0, 1.62, 2.16)).norm(), 1e-11);
    EXPECT_NEAR(world.bodies().position[1][1], 0.5, 1e-11);
}

TEST(Substeps, GiveTheBitsOfShorterSteps) {
    PhysicsSettings settings;
    settings.iterations = 4;
    Stepper fine(mixed_heap(), settings);
    settings.substeps = 4;
    Stepper coarse(mixed_heap(), settings);
    // A quarter of 2^-6 is exact, so that both make the same sub-steps.
    for (int i = 0; i < 60; ++i) {
        const StepReport report = coarse.step(1.0 / 64);
        StepReport expected;
        for (int k = 0; k < 4; ++k) expected = fine.step(1.0 / 256);
        ASSERT_EQ(report.contacts, expected.contacts) << i;
        ASSERT_EQ(report.penetration, expected.penetration) << i;
    }
    EXPECT_TRUE(same_bits(coarse.bodies(), fine.bodies()));
    EXPECT_TRUE(same_values(coarse.memory(), fine.memory()));
}

/// Struck in the first of 8 sub-steps by a sphere at 100 m/s, the middle one flies off to the last
/// within the step, far outside the bounds that it had at rest.
TEST(Substeps, SeeWhatAContactMadeFast) {
    Bodies bodies;
    for (const double x : {-0.25, 0.0, 1.2}) add(bodies, sphere_type(0.1, 1, 0, 1), {x, 0, 0, 0});
    bodies.velocity[0] = {100, 0, 0, 0};
    PhysicsSettings settings;
    settings.gravity.setZero();
    settings.substeps = 8;
    Stepper world(bodies, settings);
    for (int i = 0; i < 3; ++i) world.step(1.0 / 60);
    // Equal masses, e = 1: each stops and hands its velocity on.
    for (const BodyId id : {0u, 1u}) EXPECT_LT(world.bodies().velocity[id].norm(), 1e-11);
    EXPECT_NEAR(world.bodies().velocity[2][0], 100, 1e-11);
}

/// A sphere of radius 0.1 m at 200 m/s, 60 steps a second: 3.3 m a step against a wall of 0.2 m.
TEST(Substeps, ABulletDoesNotPassAThinWall) {
    for (const double restitution : {0.0, 0.5})
        for (int start = 0; start < 50; ++start)
            for (const Vec4& aside : {Vec4(0, 0, 0, 0), Vec4(0, 0.5, -0.4, 0.7)}) {
                Bodies bodies;
                BodyType wall = box_type({0.2, 60, 60, 60});
                wall.fixed_position = wall.fixed_rotation = true;
                wall.restitution = restitution;
                add(bodies, wall);
                const Vec4 direction = (Vec4::UnitX() + aside).normalized();
                add(bodies, sphere_type(0.1, 1, 0.3), -(5 + 0.1 * start) * direction,
                    200 * direction);
                Stepper world(bodies, PhysicsSettings{});
                for (int i = 0; i < 10; ++i) {
                    world.step(1.0 / 60);
                    // In front of the wall, whose face is at -0.1, but for the slop.
                    ASSERT_LT(world.bodies().position[1][0], -0.2 + 0.001)
                        << start << " " << aside.transpose();
                }
            }
}

/// Pairs are found by the balls in the bounds: a body may not leave its own toward a corner either.
TEST(Bounds, AreOutgrownInEveryDirectionAtTheSameDistance) {
    Bodies bodies;
    add(bodies, sphere_type(0.5), Vec4::Zero(), {4, 0, 0, 0});
    PhysicsSettings settings;
    settings.substeps = 4;
    settings.gravity.setZero();
    const Simulation simulation = make_simulation(bodies, settings);
    StepData step;
    begin_step(simulation, step, 1.0 / 60);
    advance_first_half(simulation, step, {0, 1});
    update_bounds(simulation, step, {0, 1});
    const Vec4 start = step.position[0];
    // It may move by its speed times three of the four sub-steps; the fourth is still to come.
    const double slack = 4 * 0.75 / 60;
    for (const Vec4& direction : {Vec4(1, 0, 0, 0), Vec4(0, 0, -1, 0), Vec4(0.5, 0.5, -0.5, 0.5)}) {
        step.position[0] = start + (slack - 1e-9) * direction;
        EXPECT_FALSE(outgrows_bounds(simulation, step, {0, 1}));
        step.position[0] = start + (slack + 1e-9) * direction;
        EXPECT_TRUE(outgrows_bounds(simulation, step, {0, 1})) << direction.transpose();
    }
}

TEST(Substeps, MustBeAtLeastOne) {
    PhysicsSettings settings;
    settings.substeps = 0;
    EXPECT_THROW(Stepper(Bodies{}, settings), InputError);
}

}  // namespace
}  // namespace tesserae
