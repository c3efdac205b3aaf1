// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

TEST(Flight, OfAProjectileIsExactAtAnyTimeStep) {
    PhysicsSettings settings;
    settings.gravity = {1, -10, 0.5, -2};
    const Vec4 x0{1, 2, -3, 4}, v0{5, 20, -7, 3};
    for (int steps_per_second : {10, 60, 240}) {
        Bodies bodies;
        add(bodies, sphere_type(0.5), x0, v0);
        Stepper world(bodies, settings);
        for (int i = 0; i < 2 * steps_per_second; ++i) world.step(1.0 / steps_per_second);
        const double t = 2;
        const Vec4 x = x0 + t * v0 + 0.5 * t * t * settings.gravity;
        // Every step rounds coordinates below 64 m four times, by half an ulp.
        const double error = 2 * steps_per_second * 4 * 64 * std::numeric_limits<double>::epsilon();
        EXPECT_LT((world.bodies().position[0] - x).norm(), error);
        EXPECT_LT((world.bodies().velocity[0] - v0 - t * settings.gravity).norm(), error);
    }
}

TEST(Flight, OfALoneBoxTurnsItAndKeepsItsSpinInTwoOrthogonalPlanes) {
    PhysicsSettings settings;
    settings.gravity = {0, -10, 0, 0};
    Bodies bodies;
    Bivector omega;
    omega.xy = 1.5;
    omega.zw = -0.7;
    add(bodies, box_type({1, 2, 3, 4}), Vec4::Zero(), Vec4::Zero(), omega);
    Stepper world(bodies, settings);
    for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
    // Rotations in xy and zw are steady for every J: after 1 s the angles are 1.5 and -0.7 rad.
    const Rotor expected = exp(-0.5 * omega);
    const Mat4 difference = to_matrix(world.bodies().rotor[0]) - to_matrix(expected);
    EXPECT_LT(difference.norm(), 1e-12);  // 480 turns, each rounded to some 1e-16
    EXPECT_NEAR(world.bodies().position[0][1], -5, 1e-12);
    EXPECT_LT(norm(world.bodies().angular_velocity[0] - omega), 1e-12);
}

TEST(Flight, MovesNothingThatIsFixedAndHasNoVelocity) {
    Bodies bodies;
    BodyType fixed = sphere_type(1);
    fixed.fixed_position = fixed.fixed_rotation = true;
    add(bodies, fixed, {1, 2, 3, 4});
    add(bodies, plane_type(Vec4::UnitY(), 0));
    Stepper world(bodies, PhysicsSettings{});
    for (int i = 0; i < 100; ++i) world.step(0.01);
    EXPECT_TRUE(same_bits(world.bodies(), bodies));
}

TEST(TimeStep, MustBeFiniteAndPositive) {
    Stepper world(Bodies{}, PhysicsSettings{});
    for (double dt : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                      std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(world.step(dt), InputError);
    EXPECT_NO_THROW(world.step(1e-3));
}

TEST(FiniteRange, LeftByABodyNamesTheLowestAndKeepsTheLastGoodState) {
    Bodies bodies;
    for (int i = 0; i < 6; ++i)
        add(bodies, sphere_type(0.5), {5.0 * i, 0, 0, 0}, {0, i == 3 || i == 5 ? 1e150 : 0, 0, 0});
    PhysicsSettings settings;
    settings.gravity = {0, 4e153, 0, 0};  // the squares overflow beyond 1.3e154
    Stepper world(bodies, settings);
    Bodies good;
    StepMemory memory;
    try {
        for (int i = 0; i < 100; ++i) {
            good = world.bodies();
            memory = world.memory();
            world.step(0.5);
        }
        FAIL() << "no body left the finite range";
    } catch (const LeftFiniteRange& error) {
        EXPECT_EQ(error.body, 0u);
        EXPECT_EQ(error.time, memory.time + 0.5);
        EXPECT_NE(std::string(error.what()).find("body 0 "), std::string::npos) << error.what();
    }
    EXPECT_TRUE(same_bits(world.bodies(), good));
    EXPECT_TRUE(same_values(world.memory(), memory));
}

TEST(FiniteRange, IsCheckedFromTheFirstStepOn) {
    Bodies bodies;
    add(bodies, sphere_type(0.5));
    add(bodies, sphere_type(0.5), {5, 0, 0, 0}, {1e200, 0, 0, 0});
    add(bodies, sphere_type(0.5), {9, 0, 0, 0}, Vec4::Zero(), {1e300, 0, 0, 0, 0, 0});
    Stepper world(bodies, PhysicsSettings{});
    try {
        world.step(0.01);
        FAIL();
    } catch (const LeftFiniteRange& error) {
        EXPECT_EQ(error.body, 1u);
    }
}

}  // namespace
}  // namespace tesserae
