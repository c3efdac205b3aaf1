// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

template <class S>
struct ShapeDistance : ::testing::Test {};
TYPED_TEST_SUITE(ShapeDistance, BoundedShapes);

constexpr int kPointsPerShape = 100;
constexpr int kShapes = 60;

/// Calls check(shape, oracle, point, error bound of the distance there).
template <class S, class Check>
void for_points(std::uint64_t seed, const Check& check) {
    RandomGeometry random(seed);
    for (const S& shape : sample_shapes<S>(random, kShapes)) {
        const Oracle oracle(shape);
        for (int i = 0; i < kPointsPerShape; ++i) {
            Vec4 p = sample_point(shape, random);
            if (i % 10 == 0) p *= 1e4;
            check(shape, oracle, p, kDistanceAccuracy * (stable_norm(p) + oracle.size), random);
        }
    }
}

TYPED_TEST(ShapeDistance, MatchesAnIndependentClosestPoint) {
    for_points<TypeParam>(411, [](const auto& shape, const Oracle& oracle, const Vec4& p,
                                  double error, RandomGeometry&) {
        const LVec point = p.cast<long double>();
        EXPECT_NEAR(signed_distance(shape, p), double(oracle.signed_distance(point)), error)
            << oracle.size << " " << p.transpose();
    });
}

TYPED_TEST(ShapeDistance, IsTheLargestGapOfAnyHalfSpaceThatHoldsTheShape) {
    // Duality for convex sets, inside and outside: distance = max of n . p - support(n) over unit
    // n. No direction exceeds it, and the normal attains it.
    for_points<TypeParam>(412, [](const auto& shape, const Oracle& oracle, const Vec4& p,
                                  double error, RandomGeometry& random) {
        const double distance = signed_distance(shape, p);
        const auto gap = [&](const Vec4& n) {
            const LVec direction = n.cast<long double>();
            return double(direction.dot(p.cast<long double>()) - oracle.support(direction));
        };
        for (int k = 0; k < 10; ++k) EXPECT_LE(gap(random.direction()), distance + error);
        // At a ball's centre and on a capsule's core the choice is any normal to it; it attains
        // too.
        EXPECT_NEAR(gap(normal(shape, p)), distance, error) << oracle.size << " " << p.transpose();
    });
}

TYPED_TEST(ShapeDistance, IsNegativeExactlyInside) {
    for_points<TypeParam>(413, [](const auto& shape, const Oracle& oracle, const Vec4& p,
                                  double error, RandomGeometry&) {
        const double outside = double(oracle.outside(p.cast<long double>()));
        const double distance = signed_distance(shape, p);
        if (outside > error) {
            EXPECT_GT(distance, 0);
        } else if (distance > 0) {
            EXPECT_LE(distance, 2 * error);
        }
        if (distance < -error) {
            EXPECT_EQ(outside, 0);
        }
    });
}

TYPED_TEST(ShapeDistance, IsConvexAndLipschitz) {
    RandomGeometry random(414);
    for (const TypeParam& shape : sample_shapes<TypeParam>(random, kShapes))
        for (int i = 0; i < kPointsPerShape; ++i) {
            const Vec4 a = sample_point(shape, random), b = sample_point(shape, random);
            const double t = random.uniform(0, 1);
            const double fa = signed_distance(shape, a), fb = signed_distance(shape, b);
            // Each of three distances may be off by its bound, and the point between as much.
            const double error =
                4 * kDistanceAccuracy * (stable_norm(a) + stable_norm(b) + bounding_radius(shape));
            EXPECT_LE(signed_distance(shape, (1 - t) * a + t * b), (1 - t) * fa + t * fb + error);
            EXPECT_LE(std::abs(fa - fb), stable_norm(a - b) + error);
        }
}

TYPED_TEST(ShapeDistance, HasTheNormalAsItsGradient) {
    for_points<TypeParam>(415, [](const auto& shape, const Oracle& oracle, const Vec4& p,
                                  double error, RandomGeometry& random) {
        const Vec4 n = normal(shape, p);
        EXPECT_NEAR(n.norm(), 1, 1e-15);
        // A convex function's gradient lies between its differences behind and ahead, on edges as
        // well as where it is smooth, whatever the step.
        const double step = 1e-3 * oracle.size, f = signed_distance(shape, p);
        const double rounding = 3 * (error + kDistanceAccuracy * step) / step;
        for (int i = 0; i < 4; ++i) {
            const Vec4 e = step * Vec4::Unit(i);
            EXPECT_LE((f - signed_distance(shape, p - e)) / step, n[i] + rounding);
            EXPECT_GE((signed_distance(shape, p + e) - f) / step, n[i] - rounding);
        }
        // And it supports the function everywhere.
        const Vec4 q = sample_point(shape, random);
        const double slack =
            4 * kDistanceAccuracy * (stable_norm(q) + stable_norm(p) + oracle.size);
        EXPECT_GE(signed_distance(shape, q), f + n.dot(q - p) - slack);
    });
}

TYPED_TEST(ShapeDistance, MatchesCentralDifferencesWhereSmooth) {
    // At one size or more from the shape the curvature is at most 1/size, so central differences of
    // step h = 1e-5 size are off by h^2 / (6 size^2) < 1e-10, and by 4e-10 from rounding. A capsule
    // or box has places where the curvature jumps: there they are off by h / (2 size) at most.
    const double tolerance = std::is_same_v<TypeParam, Hypersphere> ? 5e-10 : 5.1e-6;
    RandomGeometry random(416);
    for (int trial = 0; trial < kShare<TypeParam> * 3000; ++trial) {
        const TypeParam shape = random_shape<TypeParam>(random);
        const double size = bounding_radius(shape), h = 1e-5 * size;
        const Vec4 p = random.uniform(2, 3) * size * random.direction();
        const Vec4 n = normal(shape, p);
        for (int i = 0; i < 4; ++i) {
            const Vec4 e = h * Vec4::Unit(i);
            const double rise = signed_distance(shape, p + e) - signed_distance(shape, p - e);
            EXPECT_NEAR(rise / (2 * h), n[i], tolerance);
        }
    }
}

TYPED_TEST(ShapeDistance, IsNeverNoNumber) {
    const double values[] = {0.0, -0.0, 1e-320, -1e-200, 1e-150, 1.0, -1e150, 1e200, 1e307};
    RandomGeometry random(417);
    for (const TypeParam& shape : odd_shapes<TypeParam>())
        for (int i = 0; i < 3000; ++i) {
            Vec4 p, d;
            for (double& x : p) x = values[random.engine() % std::size(values)];
            for (double& x : d) x = values[random.engine() % std::size(values)];
            EXPECT_FALSE(std::isnan(signed_distance(shape, p))) << p.transpose();
            EXPECT_NEAR(normal(shape, p).norm(), 1, 1e-15) << p.transpose();
            EXPECT_FALSE(support(shape, p).hasNaN()) << p.transpose();
            EXPECT_FALSE(std::isnan(half_extent_along(shape, p))) << p.transpose();
            if (d.isZero(0)) continue;
            const double t = ray_hit(shape, p, stable_normalized(d));
            EXPECT_GE(t, 0) << p.transpose();
        }
}

TEST(StableNorm, MatchesLongDouble) {
    RandomGeometry random(418);
    for (int trial = 0; trial < 20000; ++trial) {
        const Vec4 v = random.log_uniform(1e-300, 1e300) * random.direction();
        const long double exact = v.cast<long double>().norm();
        EXPECT_NEAR(double(stable_norm(v) / exact), 1, 8.9e-16) << v.transpose();
        const LVec unit = v.cast<long double>() / exact;
        EXPECT_LE((stable_normalized(v).cast<long double>() - unit).norm(), 8.9e-16L);
    }
    EXPECT_EQ(stable_norm(Vec4::Zero()), 0);
    EXPECT_EQ(stable_norm({0, 5e-324, 0, 0}), 5e-324);
    EXPECT_EQ(stable_normalized({0, -5e-324, 0, 0}), -Vec4::UnitY());
    EXPECT_EQ(stable_norm(Vec4::Constant(1e308)), kMiss);
}

}  // namespace
}  // namespace tesserae
