// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

TEST(Hypersphere, HasTheClosedFormsOfATwoMetreBall) {
    const Hypersphere ball{2};
    EXPECT_DOUBLE_EQ(volume(ball), 8 * M_PI * M_PI);        // pi^2 2^4 / 2
    EXPECT_EQ(second_moments(ball, 3), Vec4::Constant(2));  // 3 * 4 / 6
    EXPECT_EQ(signed_distance(ball, {1, -1, 1, -1}), 0);    // |p| = 2
    EXPECT_EQ(signed_distance(ball, Vec4::Zero()), -2);
    EXPECT_EQ(normal(ball, {0, 0, 0, -7}), -Vec4::UnitW());
    EXPECT_EQ(ray_hit(ball, {-10, 0, 0, 0}, Vec4::UnitX()), 8);
    EXPECT_EQ(ray_hit(ball, {-10, 0, 0, 0}, -Vec4::UnitX()), kMiss);
    EXPECT_EQ(ray_hit(ball, {-10, 0, 2.1, 0}, Vec4::UnitX()), kMiss);
    EXPECT_EQ(ray_hit(ball, {0.5, 0, 0, 0}, Vec4::UnitX()), 0);
    EXPECT_EQ(ray_hit(ball, {-10, 2, 0, 0}, Vec4::UnitX()), 10);  // tangent: touches
}

TEST(Hypersphere, ChoosesUpAtItsCentre) {
    EXPECT_EQ(normal(Hypersphere{3}, Vec4::Zero()), Vec4::UnitY());
    EXPECT_EQ(support(Hypersphere{3}, Vec4::Zero()), 3 * Vec4::UnitY());
}

TEST(Hypersphere, IsHitExactlyFromFarAway) {
    // A ray through a known surface point u R from 1e4 R away, along a known chord: t = distance.
    RandomGeometry random(441);
    for (int trial = 0; trial < 5000; ++trial) {
        const Hypersphere ball{random.log_uniform(1e-3, 1e3)};
        const Vec4 u = random.direction(), d = random.direction();
        if (u.dot(d) > -0.01) continue;  // the entry, not grazing
        const double far = 1e4 * ball.radius;
        const Vec4 o = ball.radius * u - far * d;
        EXPECT_NEAR(ray_hit(ball, o, d), far, 1e-9 * far);
        // Rounding of the origin, 1e4 eps R, over the cosine of incidence.
        EXPECT_NEAR(ray_hit(ball, o, d), far, 4e-15 * far / -u.dot(d));
    }
}

}  // namespace
}  // namespace tesserae
