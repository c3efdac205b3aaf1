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

}  // namespace
}  // namespace tesserae
