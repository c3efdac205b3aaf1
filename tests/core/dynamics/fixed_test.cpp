// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

TEST(FixedPosition, StaysWhileTheBodyIsMadeToSpin) {
    Bodies bodies;
    BodyType wheel = sphere_type(1, 1, 1, 0);
    wheel.fixed_position = true;
    add(bodies, wheel);
    // Passes so that it grazes the wheel at 2 m/s, half a radius deep.
    add(bodies, sphere_type(1, 1, 1, 0), {-3, 1.5, 0, 0}, {2, 0, 0, 0});
    Stepper world(bodies, without_gravity());
    for (int i = 0; i < 480; ++i) world.step(1.0 / 240);
    EXPECT_EQ(world.bodies().position[0], Vec4(Vec4::Zero()));
    EXPECT_EQ(world.bodies().velocity[0], Vec4(Vec4::Zero()));
    EXPECT_LT(world.bodies().angular_velocity[0].xy, -0.1);  // its top is dragged along +x
}

TEST(FixedPosition, MeansThatGravityDoesNotAct) {
    Bodies bodies;
    BodyType held = box_type({1, 2, 3, 4});
    held.fixed_position = true;
    Bivector spin;
    spin.xy = 2;
    add(bodies, held, {1, 2, 3, 4}, Vec4::Zero(), spin);
    Stepper world(bodies, PhysicsSettings{});
    for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
    EXPECT_EQ(world.bodies().position[0], Vec4(1, 2, 3, 4));
    const Mat4 turned = to_matrix(world.bodies().rotor[0]);
    EXPECT_LT((turned - to_matrix(exp(-0.5 * spin))).norm(), 1e-12);
}

TEST(FixedRotation, SlidesToAStopWithoutSpinning) {
    Bodies bodies;
    BodyType block = sphere_type(0.5, 2, 0.5, 0);
    block.fixed_rotation = true;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    add(bodies, block, {0, 0.5, 0, 0}, {2, 0, 0, 0});
    Stepper world(bodies, PhysicsSettings{});
    for (int i = 0; i < 240; ++i) world.step(1.0 / 240);
    // Slows at mu g = 5 m/s^2 over v^2 / (2 mu g) = 0.4 m. In the step in which it stops the
    // mean velocity is right, the time that it acts wrong by up to h = 1/240 s.
    EXPECT_NEAR(world.bodies().position[1][0], 0.4, 0.5 * 5 / 240.0 / 240.0 + 1e-12);
    EXPECT_LT(world.bodies().velocity[1].norm(), 1e-12);
    EXPECT_EQ(world.bodies().angular_velocity[1], Bivector{});
    EXPECT_EQ(world.bodies().rotor[1], Rotor{});
}

TEST(KinematicBody, PushesAndIsNotHeldUp) {
    Bodies bodies;
    BodyType pusher = sphere_type(1, 1, 0, 0);
    pusher.fixed_position = pusher.fixed_rotation = true;
    const Vec4 v{0, 0, 0, 1.5};
    add(bodies, pusher, Vec4::Zero(), v);
    add(bodies, sphere_type(0.5, 1e6), {0, 0, 0, 2.5});  // 1 m ahead, heavy
    Stepper world(bodies, without_gravity());
    for (int i = 0; i < 480; ++i) world.step(1.0 / 240);
    EXPECT_EQ(world.bodies().velocity[0], v);
    EXPECT_NEAR(world.bodies().position[0][3], 3, 1e-12);
    EXPECT_NEAR(world.bodies().velocity[1][3], 1.5, 1e-12);
    EXPECT_NEAR(world.bodies().position[1][3], 4.5, 1e-12);
}

TEST(KinematicBody, DragsAlongWhatLiesOnItBySpinning) {
    Bodies bodies;
    BodyType roller = sphere_type(1, 1, 1, 0);
    roller.fixed_position = roller.fixed_rotation = true;
    Bivector spin;
    spin.xy = -1;  // the top moves along +x at 1 m/s
    add(bodies, roller, Vec4::Zero(), Vec4::Zero(), spin);
    add(bodies, sphere_type(0.5, 1, 1, 0), {0, 1.5, 0, 0});
    Stepper world(bodies, PhysicsSettings{});
    for (int i = 0; i < 24; ++i) world.step(1.0 / 240);
    EXPECT_EQ(world.bodies().angular_velocity[0], spin);
    // Rolling on a surface that runs at u: the contact points match, v + omega_xy R = u, and the
    // impulse gives m v = I omega_xy / R, so v = u / 4, less what rolling off changes in 0.1 s
    // (5 cm of 1.5 m: a slope of 1/60 at the end, with 10 m/s^2 some 0.01 m/s).
    EXPECT_NEAR(world.bodies().velocity[1][0], 0.25, 0.02);
    EXPECT_NEAR(world.bodies().angular_velocity[1].xy, 1.5, 0.05);
}

}  // namespace
}  // namespace tesserae
