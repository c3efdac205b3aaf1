// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/bodies/bodies.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "core/algebra/bivector.hpp"

namespace tesserae {
namespace {

/// Half a metre along every axis and a quarter turn in xw, seen after a third of the way.
TEST(InterpolatePoses, MovesAlongALineAndTurnsEvenly) {
    Bodies before;
    before.types = {BodyType{Hypersphere{1}}};
    before.type = {0, 0};
    before.position = {Vec4(1, 2, 3, 4), Vec4(-1, 0, 0, 0)};
    before.rotor = {Rotor{}, exp(Bivector{.yz = 0.3})};
    before.velocity = {Vec4::Zero(), Vec4::Ones()};
    before.angular_velocity.resize(2);
    Bodies after = before;
    after.position[0] += Vec4::Constant(0.5);
    after.rotor[0] = exp(Bivector{.xw = std::numbers::pi / 4});

    Bodies between = before;
    interpolate_poses(before, after, 1.0 / 3, between);
    EXPECT_LE((between.position[0] - Vec4(7, 13, 19, 25) / 6).norm(), 1e-15);
    const Rotor sixth = exp(Bivector{.xw = std::numbers::pi / 12});
    EXPECT_LE((to_matrix(between.rotor[0]) - to_matrix(sixth)).norm(), 1e-15);
    EXPECT_EQ(between.position[1], before.position[1]);
    EXPECT_EQ(between.rotor[1], before.rotor[1]);
    EXPECT_EQ(between.velocity[1], before.velocity[1]);
}

TEST(InterpolatePoses, MayOverwriteTheEarlierOnes) {
    Bodies before;
    before.types = {BodyType{Hypersphere{1}}};
    before.type = {0};
    before.position = {Vec4(1, 0, 0, 2)};
    before.rotor = {exp(Bivector{.xy = 0.2, .zw = -1})};
    Bodies after = before;
    after.position = {Vec4(3, 0, 1, 0)};
    after.rotor = {exp(Bivector{.xz = 1, .zw = 0.4})};
    Bodies apart = before;
    interpolate_poses(before, after, 0.7, apart);
    interpolate_poses(before, after, 0.7, before);
    EXPECT_EQ(before.position[0], apart.position[0]);
    EXPECT_EQ(before.rotor[0], apart.rotor[0]);
}

Bodies one_body(const Rotor& rotor, const Bivector& angular_velocity) {
    Bodies bodies;
    bodies.types = {BodyType{Hypersphere{1}}};
    bodies.type = {0};
    bodies.position = bodies.velocity = {Vec4::Zero()};
    bodies.rotor = {rotor}, bodies.angular_velocity = {angular_velocity};
    return bodies;
}

/// Of a random double rotation: closed form exp(-t/2 omega).
TEST(Turning, FollowsTheAngularVelocityHoweverFast) {
    const Bivector omega{.xy = 3, .xw = 1, .yz = -2, .zw = 5};
    const Rotor start = exp(Bivector{.xz = 0.4, .yw = -0.3});
    for (const double time : {0.01, 0.5, 1.0, 3.0, 10.0}) {
        const Bodies before = one_body(start, omega);
        Bodies after = before;
        after.rotor[0] = exp(-0.5 * time * omega) * start;
        const Turning found = turning(before, after, time, 0).value();
        for (const double part : {0.0, 0.1, 0.5, 0.77, 1.0}) {
            const Rotor exact = exp(-0.5 * part * time * omega) * start;
            EXPECT_LE((to_matrix(found.at(part)) - to_matrix(exact)).norm(), 1e-12) << time;
        }
        // What is the same at both ends has stopped.
        EXPECT_FALSE(turning(before, before, time, 0));
    }
}

TEST(Turning, EndsWhereItShouldAndTakesTheShortestWayWithoutVelocity) {
    Bodies before = one_body(exp(Bivector{.xy = 0.2, .zw = -1}), {});
    Bodies after = before, shortest = before;
    after.rotor[0] = exp(Bivector{.xz = 1, .zw = 0.4});
    const Turning found = turning(before, after, 2, 0).value();
    for (const double part : {0.25, 0.5, 1.0}) {
        interpolate_poses(before, after, part, shortest);
        EXPECT_LE((to_matrix(found.at(part)) - to_matrix(shortest.rotor[0])).norm(), 1e-14);
    }
    // An impact in between: the velocities do not lead to the end, the way does.
    before.angular_velocity[0].yw = 7, after.angular_velocity[0].xy = -20;
    const Turning blown = turning(before, after, 2, 0).value();
    EXPECT_LE((to_matrix(blown.at(1)) - to_matrix(after.rotor[0])).norm(), 1e-13);
    EXPECT_LE((to_matrix(blown.at(0)) - to_matrix(before.rotor[0])).norm(), 1e-14);
}

}  // namespace
}  // namespace tesserae
