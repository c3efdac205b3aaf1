// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/algebra/rotor.hpp"
#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

template <class S>
struct ShapeBounds : ::testing::Test {};
TYPED_TEST_SUITE(ShapeBounds, BoundedShapes);

template <class S>
struct ShapeBoundsSlow : ::testing::Test {};
TYPED_TEST_SUITE(ShapeBoundsSlow, BoundedShapes);

/// A few roundings of a sum of five terms.
constexpr double kBoundsRounding = 4e-15;

Mat4 random_rotation(RandomGeometry& random) {
    const auto angle = [&] { return random.uniform(-3, 3); };
    return to_matrix(exp(Bivector{angle(), angle(), angle(), angle(), angle(), angle()}));
}

/// A point of the shape's surface: where a ray from inside leaves it, by bisection on the oracle.
Vec4 surface_point(const Oracle& oracle, RandomGeometry& random) {
    const LVec d = random.direction().cast<long double>();
    long double inside = 0, outside = 2.0L * oracle.size;
    for (int i = 0; i < 70; ++i) {
        const long double middle = (inside + outside) / 2;
        (oracle.holds(middle * d) ? inside : outside) = middle;
    }
    return (inside * d).cast<double>();
}

template <class S>
void expect_maximal_support(std::size_t shapes) {
    RandomGeometry random(421);
    for (const S& shape : sample_shapes<S>(random, shapes)) {
        const Oracle oracle(shape);
        for (int i = 0; i < 40; ++i) {
            Vec4 d = random.direction();
            if (i % 4 == 0) d[random.engine() % 4] = 0;
            if (i % 8 == 0) d = Vec4::Unit(random.engine() % 4) * (i % 16 ? 1 : -1);
            d *= random.log_uniform(1e-3, 1e3);
            const Vec4 farthest = support(shape, d);
            const double error = kBoundsRounding * oracle.size;
            EXPECT_LE(double(oracle.outside(farthest.cast<long double>())), error);
            const double reach = d.dot(farthest);
            const double back = (-d).dot(support(shape, -d));
            EXPECT_NEAR(std::max(reach, back), half_extent_along(shape, d), error * d.norm());
            for (int k = 0; k < 10; ++k)
                EXPECT_LE(d.dot(surface_point(oracle, random)), reach + error * d.norm());
        }
        EXPECT_LE(double(oracle.outside(support(shape, Vec4::Zero()).template cast<long double>())),
                  kBoundsRounding * oracle.size);
    }
}

TYPED_TEST(ShapeBounds, SupportIsMaximalAndBelongsToTheShape) {
    expect_maximal_support<TypeParam>(20);
}
TYPED_TEST(ShapeBoundsSlow, SupportIsMaximalAndBelongsToTheShape) {
    expect_maximal_support<TypeParam>(60);
}

template <class S>
void expect_bounds_of_turned_shape(std::size_t shapes) {
    RandomGeometry random(422);
    for (const S& shape : sample_shapes<S>(random, shapes)) {
        const Oracle oracle(shape);
        for (int i = 0; i < 20; ++i) {
            const Mat4 rotation = i ? random_rotation(random) : Mat4(Mat4::Identity());
            const Vec4 half = half_extents(shape, rotation);
            const double error = kBoundsRounding * oracle.size;
            for (int k = 0; k < 20; ++k) {
                const Vec4 p = rotation * surface_point(oracle, random);
                EXPECT_LE((p.cwiseAbs() - half).maxCoeff(), error);
            }
            for (int axis = 0; axis < 4; ++axis) {
                const Vec4 along = rotation.row(axis);
                const double up = (rotation * support(shape, along))[axis];
                const double down = -(rotation * support(shape, -along))[axis];
                EXPECT_NEAR(std::max(up, down), half[axis], error);
                EXPECT_NEAR(half_extent_along(shape, along), half[axis], error);
            }
        }
    }
}

TYPED_TEST(ShapeBounds, HoldTheTurnedShapeAndAreAttained) {
    expect_bounds_of_turned_shape<TypeParam>(20);
}
TYPED_TEST(ShapeBoundsSlow, HoldTheTurnedShapeAndAreAttained) {
    expect_bounds_of_turned_shape<TypeParam>(60);
}

TYPED_TEST(ShapeBounds, BoundingRadiusIsTheFarthestPoint) {
    RandomGeometry random(423);
    for (const TypeParam& shape : sample_shapes<TypeParam>(random, 300)) {
        const Oracle oracle(shape);
        const double radius = bounding_radius(shape), error = kBoundsRounding * radius;
        for (int k = 0; k < 20; ++k)
            EXPECT_LE(stable_norm(surface_point(oracle, random)), radius + error);
        // It is attained along one of the axes or diagonals.
        double farthest = 0;
        for (int code = 1; code < 81; ++code) {
            const Vec4 d(code % 3 - 1, code / 3 % 3 - 1, code / 9 % 3 - 1, code / 27 - 1);
            farthest = std::max(farthest, stable_norm(support(shape, d)));
        }
        EXPECT_NEAR(farthest, radius, error);
    }
}

}  // namespace
}  // namespace tesserae
