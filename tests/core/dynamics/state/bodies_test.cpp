#include "core/dynamics/state/bodies.hpp"

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

/// Turns of a random double rotation: closed form exp(-t/2 omega).
TEST(FollowPoses, TurnsAtTheAngularVelocityHoweverFast) {
    const Bivector omega{.xy = 3, .xw = 1, .yz = -2, .zw = 5};
    const Rotor start = exp(Bivector{.xz = 0.4, .yw = -0.3});
    for (const double time : {0.01, 0.5, 1.0, 3.0, 10.0}) {
        Bodies before;
        before.types = {BodyType{Hypersphere{1}}};
        before.type = {0};
        before.position = {Vec4::Zero()}, before.velocity = {Vec4::Zero()};
        before.rotor = {start}, before.angular_velocity = {omega};
        Bodies after = before, found = before;
        after.position[0] = {4, 0, 2, 0};
        after.rotor[0] = exp(-0.5 * time * omega) * start;
        for (const double part : {0.0, 0.1, 0.5, 0.77, 1.0}) {
            follow_poses(before, after, time, part, found);
            const Rotor exact = exp(-0.5 * part * time * omega) * start;
            EXPECT_LE((to_matrix(found.rotor[0]) - to_matrix(exact)).norm(), 1e-12) << time;
            EXPECT_LE((found.position[0] - part * after.position[0]).norm(), 1e-14);
        }
        // What is the same at both ends has stopped.
        follow_poses(before, before, time, 0.3, found);
        EXPECT_EQ(found.rotor[0], start);
    }
}

TEST(FollowPoses, EndsWhereItShouldAndTakesTheShortestWayWithoutVelocity) {
    Bodies before;
    before.types = {BodyType{Hypersphere{1}}};
    before.type = {0};
    before.position = {Vec4::Zero()}, before.velocity = {Vec4::Zero()};
    before.rotor = {exp(Bivector{.xy = 0.2, .zw = -1})};
    before.angular_velocity = {Bivector{}};
    Bodies after = before, found = before, shortest = before;
    after.rotor[0] = exp(Bivector{.xz = 1, .zw = 0.4});
    for (const double part : {0.25, 0.5, 1.0}) {
        follow_poses(before, after, 2, part, found);
        interpolate_poses(before, after, part, shortest);
        EXPECT_LE((to_matrix(found.rotor[0]) - to_matrix(shortest.rotor[0])).norm(), 1e-14);
    }
    // A blow in between: the velocities do not lead to the end, the way does.
    before.angular_velocity[0].yw = 7, after.angular_velocity[0].xy = -20;
    follow_poses(before, after, 2, 1, found);
    EXPECT_LE((to_matrix(found.rotor[0]) - to_matrix(after.rotor[0])).norm(), 1e-13);
    follow_poses(before, after, 2, 0, found);
    EXPECT_LE((to_matrix(found.rotor[0]) - to_matrix(before.rotor[0])).norm(), 1e-14);
}

}  // namespace
}  // namespace tesserae
