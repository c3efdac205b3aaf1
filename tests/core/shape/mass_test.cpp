// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

template <class S>
struct ShapeMass : ::testing::Test {};
TYPED_TEST_SUITE(ShapeMass, BoundedShapes);

/// Sums over points of the shape: their number, x_i, x_i x_j and (x_i x_j)^2.
struct Sums {
    double inside = 0;
    Vec4 first = Vec4::Zero();
    Mat4 second = Mat4::Zero(), fourth = Mat4::Zero();
};

/// Uniform points of a box, kept where the shape's own distance says inside.
template <class S>
Sums sample_inside(const S& shape, const Vec4& half, int points, RandomGeometry& random) {
    Sums sums;
    const Rotor* axes = principal_axes_of(shape);
    const Mat4 to_principal = axes == nullptr ? Mat4::Identity() : to_matrix(reverse(*axes));
    for (int i = 0; i < points; ++i) {
        const Vec4 p = random.in_box(half);
        if (signed_distance(shape, p) > 0) continue;
        const Vec4 along = to_principal * p;
        const Mat4 square = along * along.transpose();
        sums.inside += 1;
        sums.first += along;
        sums.second += square;
        sums.fourth += square.cwiseProduct(square);
    }
    return sums;
}

constexpr int kPoints = 200000;
/// About 200 comparisons: one beyond five sigma by chance once in 10^4 seeds.
constexpr double kSigmas = 5;

TYPED_TEST(ShapeMass, MatchesMonteCarloOverTheSignedDistance) {
    RandomGeometry random(401);
    for (int trial = 0; trial < 4; ++trial) {
        TypeParam shape = random_shape<TypeParam>(random);
        // A wider box than the bounds, so that volume and bounds are tested apart.
        const Vec4 half = 1.1 * half_extents(shape, Mat4::Identity());
        const Sums sums = sample_inside(shape, half, kPoints, random);
        const double n = sums.inside, mass = 3.5;
        ASSERT_GT(n, 1000);

        // The count is binomial.
        const double hit = volume(shape) / (2 * half).prod();
        EXPECT_NEAR(n, kPoints * hit, kSigmas * std::sqrt(kPoints * hit * (1 - hit))) << trial;

        // Sample means against J and 0, with the sample's own deviation.
        const Vec4 moments = second_moments(shape, mass) / mass;
        for (int i = 0; i < 4; ++i) {
            EXPECT_NEAR(sums.first[i] / n, 0, kSigmas * std::sqrt(moments[i] / n));
            for (int j = 0; j <= i; ++j) {
                const double mean = sums.second(i, j) / n;
                const double sigma = std::sqrt((sums.fourth(i, j) / n - mean * mean) / n);
                EXPECT_NEAR(mean, i == j ? moments[i] : 0, kSigmas * sigma) << i << j;
            }
        }
    }
}

TYPED_TEST(ShapeMass, ScalesAsItsUnitsDo) {
    // Powers of two scale without rounding: volume with the fourth, J with the second power.
    RandomGeometry random(402);
    for (int trial = 0; trial < kShare<TypeParam> * 1000; ++trial) {
        const TypeParam shape = random_shape<TypeParam>(random);
        TypeParam larger = shape;
        TypeParam::parameters(larger,
                              [](const Key&, auto& value, Rule) { scale_parameter(value, 8); });
        complete(larger);
        EXPECT_EQ(volume(larger), 4096 * volume(shape));
        EXPECT_EQ(second_moments(larger, 2), 128 * second_moments(shape, 1));
    }
}

TYPED_TEST(ShapeMass, IsNeverNoNumber) {
    for (double size : {1e-300, 1e-150, 1e-80, 1.0, 1e80, 1e150, 1e300})
        for (double second : {1e-300, 1e-150, 1.0, 1e150, 1e300}) {
            TypeParam shape;
            bool first = true;
            TypeParam::parameters(shape, [&](const Key&, auto& value, Rule) {
                scale_parameter(value, first ? size : second);
                first = false;
            });
            complete(shape);
            EXPECT_FALSE(std::isnan(volume(shape))) << size << " " << second;
            EXPECT_FALSE(second_moments(shape, 1).hasNaN()) << size << " " << second;
        }
}

}  // namespace
}  // namespace tesserae
