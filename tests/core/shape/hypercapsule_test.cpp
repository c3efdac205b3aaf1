// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

TEST(Hypercapsule, OfNoHeightIsExactlyAHypersphere) {
    RandomGeometry random(451);
    for (int trial = 0; trial < 3000; ++trial) {
        const Hypersphere ball{random.log_uniform(1e-3, 1e3)};
        const Hypercapsule capsule{ball.radius, 0};
        const double mass = random.log_uniform(0.1, 10), r = ball.radius;
        const Vec4 p = random.in_box(Vec4::Constant(3 * r)), d = random.direction();
        EXPECT_EQ(volume(capsule), volume(ball));
        EXPECT_EQ(second_moments(capsule, mass), second_moments(ball, mass));
        EXPECT_EQ(bounding_radius(capsule), r);
        EXPECT_EQ(half_extents(capsule, Mat4::Identity()), half_extents(ball, Mat4::Identity()));
        EXPECT_EQ(half_extent_along(capsule, p), half_extent_along(ball, p));
        EXPECT_EQ(support(capsule, d), support(ball, d));
        EXPECT_EQ(signed_distance(capsule, p), signed_distance(ball, p));
        EXPECT_EQ(normal(capsule, p), normal(ball, p));
        // The wall of no height is entered at a single point, so both take the ball's own way.
        EXPECT_EQ(ray_hit(capsule, p, d), ray_hit(ball, p, d));
    }
    EXPECT_EQ(normal(Hypercapsule{1, 0}, Vec4::Zero()), Vec4::UnitY());
}

TEST(Hypercapsule, HasSecondMomentsOfItsSlices) {
    // Across y the capsule is a stack of 3-balls of radius s(y): content 4/3 pi s^3, second moment
    // along an axis of it s^2/5. Simpson's rule over y, per part, errs by less than 1e-9 here
    // (sqrt edges at the ends: s^3 ~ distance^1.5, n = 20000).
    for (const Hypercapsule capsule : {Hypercapsule{1, 2}, {0.5, 7}, {3, 0.1}, {2, 0}}) {
        const double r = capsule.radius, half = capsule.height / 2;
        double content = 0, across = 0, along = 0;
        const auto add_part = [&](double low, double high) {
            const int n = 20000;
            const double h = (high - low) / n;
            for (int i = 0; i <= n; ++i) {
                const double y = low + i * h;
                const double beyond = std::max(0.0, std::abs(y) - half);
                const double square = std::max(0.0, r * r - beyond * beyond);
                const double weight = (i == 0 || i == n ? 1 : i % 2 ? 4 : 2) * h / 3;
                const double ball = weight * 4.0 / 3 * M_PI * square * std::sqrt(square);
                content += ball;
                across += ball * square / 5;
                along += ball * y * y;
            }
        };
        add_part(-half - r, -half);
        add_part(-half, half);
        add_part(half, half + r);
        EXPECT_NEAR(volume(capsule) / content, 1, 1e-9);
        const Vec4 J = second_moments(capsule, 5);
        for (int axis : {0, 2, 3}) EXPECT_NEAR(J[axis] / (5 * across / content), 1, 1e-9);
        EXPECT_NEAR(J[1] / (5 * along / content), 1, 1e-9);
    }
}

TEST(Hypercapsule, ChoosesANormalAcrossItsCore) {
    const Hypercapsule capsule{1, 4};
    for (double y : {-2.0, -1.0, 0.0, 2.0})
        EXPECT_EQ(normal(capsule, {0, y, 0, 0}), Vec4::UnitX()) << y;
    EXPECT_EQ(normal(capsule, {0, 2.5, 0, 0}), Vec4::UnitY());
    EXPECT_EQ(normal(capsule, {0, 1, 0, -0.25}), -Vec4::UnitW());
}

TEST(Hypercapsule, IsHitOnWallCapsAndSeam) {
    const Hypercapsule capsule{1, 4};
    EXPECT_EQ(ray_hit(capsule, {-5, 0, 0, 0}, Vec4::UnitX()), 4);  // wall
    EXPECT_EQ(ray_hit(capsule, {-5, 2, 0, 0}, Vec4::UnitX()), 4);  // seam
    EXPECT_EQ(ray_hit(capsule, {0, 9, 0, 0}, -Vec4::UnitY()), 6);  // along the axis
    EXPECT_EQ(ray_hit(capsule, {1, 9, 0, 0}, -Vec4::UnitY()), 7);  // along the wall
    EXPECT_EQ(ray_hit(capsule, {1.001, 9, 0, 0}, -Vec4::UnitY()), kMiss);
    EXPECT_EQ(ray_hit(capsule, {0, -9, 0, 0}, Vec4::UnitY()), 6);
    EXPECT_EQ(ray_hit(capsule, {0, -9, 0, 0}, -Vec4::UnitY()), kMiss);
    EXPECT_EQ(ray_hit(capsule, {0, 2.9, 0, 0}, Vec4::UnitY()), 0);  // inside a cap
    EXPECT_EQ(ray_hit(capsule, {-5, 3.1, 0, 0}, Vec4::UnitX()), kMiss);
    // Nearly along the axis: the wall is entered far beyond the cap's end, or hardly ever.
    const Vec4 slant = stable_normalized({1e-200, -1, 0, 0});
    EXPECT_DOUBLE_EQ(ray_hit(capsule, {0.5, 9, 0, 0}, slant), 7 - std::sqrt(0.75));
    EXPECT_EQ(ray_hit(capsule, {1.5, 9, 0, 0}, slant), kMiss);
}

}  // namespace
}  // namespace tesserae
