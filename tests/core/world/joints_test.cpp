// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.hpp"
#include "tests/core/world/random_world.hpp"

// Joints of a World. What each does to bodies is tested in core/dynamics/constraints.
namespace tesserae {
namespace {

using namespace testing;

/// The period of a pendulum of a sphere on a hinge, by 2 pi sqrt(I / m g l) (1 + a^2 / 16).
TEST(WorldJoints, AHingeHoldsAPendulum) {
    World world;
    const double radius = 0.2, length = 1, angle = 0.1;
    const BodyId ball = world.add(
        sphere_type(radius, 3),
        {{length * std::sin(angle), -length * std::cos(angle), 0, 0}, {}, Vec4::Zero(), {}});
    JointDescription hinge{.type = JointType::kHinge};
    hinge.plane = {Vec4::UnitX(), Vec4::UnitY()};
    const JointId joint = world.join(hinge, ball);
    EXPECT_EQ(world.joint(joint).b, kWorld);
    EXPECT_EQ(world.joint(joint).a, ball);
    double last = 0, crossed = 0;
    while (crossed == 0 && world.time() < 2) {
        last = world.state(ball).position[0];
        world.step();
        if (world.state(ball).position[0] < 0)
            crossed = world.time() - kStep * world.state(ball).position[0] /
                                         (world.state(ball).position[0] - last);
    }
    const double inertia = length * length + radius * radius / 3;
    const double quarter =
        0.5 * std::numbers::pi * std::sqrt(inertia / (10 * length)) * (1 + angle * angle / 16);
    EXPECT_NEAR(crossed, quarter, 1e-4);
    const JointReading reading = world.joint(joint);
    EXPECT_NEAR(std::abs(reading.position), angle, 2e-3);  // it was 0 as it was made
    EXPECT_LT(reading.error, 1e-6);
    // The weight, and what turns the ball round.
    const double speed = world.state(ball).velocity.norm();
    EXPECT_NEAR(reading.impulse / kStep, 30 + 3 * speed * speed, 0.05);
    world.remove_joint(joint);
    EXPECT_FALSE(world.has_joint(joint));
    EXPECT_THROW(world.joint(joint), InputError);
    const double height = world.state(ball).position[1];
    for (int i = 0; i < 240; ++i) world.step();
    EXPECT_NEAR(world.state(ball).position[1], height - 5, 0.1);
}

TEST(WorldJoints, BreakAndSayIt) {
    World world;
    const BodyId ball = world.add(sphere_type(0.5, 2));
    JointDescription weld{.type = JointType::kWeld};
    weld.breaks = JointBreak{.force = 19, .torque = {}};
    const JointId weak = world.join(weld, ball);
    const BodyId other = world.add(sphere_type(0.5, 2), {{5, 0, 0, 0}, {}, Vec4::Zero(), {}});
    weld.anchor = {5, 0, 0, 0};
    weld.breaks->force = 21;
    const JointId strong = world.join(weld, other);
    world.step(), world.step();
    EXPECT_TRUE(world.joint(weak).broken);
    EXPECT_FALSE(world.joint(strong).broken);
    // It stays so when others are added and removed.
    const BodyId third = world.add(sphere_type(0.5, 2), {{9, 0, 0, 0}, {}, Vec4::Zero(), {}});
    const JointId rope = world.join({.type = JointType::kRope, .length = 6}, other, third);
    world.step();
    EXPECT_TRUE(world.joint(weak).broken);
    world.remove_joint(rope);
    EXPECT_TRUE(world.joint(weak).broken);
    EXPECT_LT(world.state(ball).position[1], 0);
    EXPECT_EQ(world.state(other).position[1], 0);
    world.remove(ball);
    EXPECT_FALSE(world.has_joint(weak));
    EXPECT_FALSE(world.joint(strong).broken);
    ASSERT_EQ(world.joint_ids().size(), 1u);
    EXPECT_EQ(world.joint_ids()[0], strong);
}

/// What a World throws at a joint, or "".
std::string error_of(const JointDescription& joint, BodyId a, BodyId b) {
    World world;
    world.add(sphere_type(1)), world.add(sphere_type(1), {{3, 0, 0, 0}, {}, Vec4::Zero(), {}});
    BodyType fixed = sphere_type(1);
    fixed.fixed_position = fixed.fixed_rotation = true;
    world.add(fixed, {{0, 9, 0, 0}, {}, Vec4::Zero(), {}});
    world.add(plane_type(Vec4::UnitY(), -20));
    const std::string before = world.save();
    try {
        world.join(joint, a, b);
    } catch (const InputError& error) {
        EXPECT_EQ(world.save(), before);
        return error.what();
    }
    return "";
}

TEST(WorldJoints, WhatCannotBeIsRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto expect = [](const JointDescription& joint, BodyId a, BodyId b, const char* part) {
        const std::string error = error_of(joint, a, b);
        EXPECT_NE(error.find(part), std::string::npos) << part << ": " << error;
    };
    JointDescription joint;
    EXPECT_EQ(error_of(joint, 0, 1), "");
    expect(joint, 0, 0, "to itself");
    expect(joint, 0, 7, "body 7: was never added");
    expect(joint, 2, kWorld, "may move");
    expect(joint, 2, 3, "may move");
    joint.anchor[2] = nan;
    expect(joint, 0, 1, "anchor.z = nan");
    joint = {.type = static_cast<JointType>(12)};
    expect(joint, 0, 1, "type = 12");
    joint = {.type = JointType::kDistance};
    EXPECT_EQ(error_of(joint, 0, 1), "");
    expect(joint, 0, kWorld, "anchors");
    expect(joint, 0, 3, "anchors");
    joint.length = 2;
    expect(joint, 0, 1, "3 m apart");
    joint = {.type = JointType::kSpring};
    expect(joint, 0, 1, "joint: spring.frequency: expected one in Hz, or a stiffness");
    joint.spring = {.frequency = 2.0, .stiffness = 3.0};
    expect(joint, 0, 1, "joint: spring.stiffness: there is a frequency too");
    joint.spring = {.frequency = -2.0};
    expect(joint, 0, 1, "frequency = -2");
    joint.spring = {.damping_force = 2.0};
    expect(joint, 0, 1, "a stiffness");
    joint.spring = {.damping = 0.5, .stiffness = 3.0};
    expect(joint, 0, 1, "spring.damping: goes with a frequency");
    joint.spring = {.frequency = 2.0, .damping_force = 2.0};
    expect(joint, 0, 1, "spring.damping_force: goes with a stiffness");
    joint = {.type = JointType::kHinge};
    joint.plane.second = joint.plane.first * 2;
    expect(joint, 0, 1, "parallel");
    joint.plane.second.setZero();
    expect(joint, 0, 1, "not zero");
    joint = {.type = JointType::kHinge};
    joint.limits[kTurning] = Vec2(0.5, 1);
    expect(joint, 0, 1, "joint: limits[4]: expected limits with 0 between them");
    joint.limits[kTurning] = Vec2(1, -1);
    expect(joint, 0, 1, "low < high");
    joint.limits[kTurning] = Vec2(-4, 1);
    expect(joint, 0, 1, "limits[4] = -4");
    joint.limits = {};
    joint.motors[kSliding] = JointMotor{.speed = 1.0};
    expect(joint, 0, 1, "motors[0]: this coordinate is held");
    joint.motors = {};
    joint.motors[kTurning] = JointMotor{.speed = 1.0, .target = 1.0};
    expect(joint, 0, 1, "motors[4].target: there is a speed too");
    joint.motors[kTurning] = JointMotor{.speed = 1.0, .damping = 1.0};
    expect(joint, 0, 1, "motors[4].damping: goes with a target");
    joint.motors[kTurning] = JointMotor{};
    expect(joint, 0, 1, "motors[4].speed: expected a speed, or a target");
    joint.motors[kTurning] = JointMotor{.speed = 1.0, .max = 0.0};
    expect(joint, 0, 1, "max = 0");
    joint = {.type = JointType::kGeneral};
    expect(joint, 0, 1, "free");
    joint.free = 1;
    joint.rotation = {2, {}, 0};
    expect(joint, 0, 1, "joint: rotation: is no rotation");
    joint = {.type = JointType::kWeld};
    joint.breaks = JointBreak{};
    expect(joint, 0, 1, "breaks.force: expected one in N, or a torque");
}

}  // namespace
}  // namespace tesserae
