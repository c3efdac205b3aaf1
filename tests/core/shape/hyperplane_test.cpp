// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

Hyperplane random_plane(RandomGeometry& random) {
    Hyperplane plane{random.log_uniform(1e-3, 1e3) * random.direction(), random.uniform(-50, 50)};
    complete(plane);
    return plane;
}

long double exact_distance(const Hyperplane& plane, const LVec& p) {
    return plane.normal.cast<long double>().dot(p) - plane.offset;
}

TEST(Hyperplane, IsCompletedToAUnitNormalFromAnyLength) {
    RandomGeometry random(461);
    for (double length : {1e-320, 1e-300, 1e-200, 1e-100, 1.0, 1e100, 1e200, 1e300})
        for (int i = 0; i < 200; ++i) {
            Hyperplane plane{length * random.direction(), 3};
            if (plane.normal.isZero(0)) continue;
            const LVec exact = plane.normal.cast<long double>().normalized();
            complete(plane);
            EXPECT_LE((plane.normal.cast<long double>() - exact).norm(), 4e-16L) << length;
            EXPECT_EQ(plane.offset, 3);
        }
    Hyperplane lopsided{{1e-200, -1e200, 0, 0}, 0};
    complete(lopsided);
    EXPECT_EQ(lopsided.normal, -Vec4::UnitY());
}

TEST(Hyperplane, IsInfinite) {
    const Hyperplane plane;
    EXPECT_EQ(volume(plane), kMiss);
    EXPECT_EQ(second_moments(plane, 1), Vec4::Constant(kMiss));
    EXPECT_EQ(bounding_radius(plane), kMiss);
    EXPECT_EQ(half_extents(plane, Mat4::Identity()), Vec4::Constant(kMiss));
    EXPECT_EQ(half_extent_along(plane, Vec4::UnitX()), kMiss);
    EXPECT_FALSE(Hyperplane::kBounded);
}

TEST(Hyperplane, HasAFarthestPointOnlyAlongItsNormal) {
    RandomGeometry random(462);
    for (int i = 0; i < 1000; ++i) {
        const Hyperplane plane = random_plane(random);
        const Vec4 p = support(plane, random.log_uniform(1e-9, 1e9) * plane.normal);
        EXPECT_EQ(p, plane.offset * plane.normal);
        EXPECT_EQ(support(plane, random.direction()), Vec4::Constant(kMiss));
        EXPECT_EQ(support(plane, -plane.normal), Vec4::Constant(kMiss));
        EXPECT_EQ(support(plane, Vec4::Zero()), p);
    }
}

TEST(Hyperplane, MeasuresAlongItsNormal) {
    RandomGeometry random(463);
    for (int i = 0; i < 5000; ++i) {
        const Hyperplane plane = random_plane(random);
        const Vec4 p = random.in_box(Vec4::Constant(random.log_uniform(0.1, 1e6)));
        const double error = kDistanceAccuracy * (p.norm() + std::abs(plane.offset));
        const double distance = signed_distance(plane, p);
        EXPECT_NEAR(distance, double(exact_distance(plane, p.cast<long double>())), error);
        // Its foot point lies on the boundary, and no nearer point of the boundary is found.
        const Vec4 foot = p - distance * normal(plane, p);
        EXPECT_NEAR(signed_distance(plane, foot), 0, 4 * error);
        Vec4 other = foot + random.in_box(Vec4::Constant(1));
        other -= signed_distance(plane, other) * plane.normal;
        EXPECT_GE((other - p).norm(), std::abs(distance) - 4 * error);
    }
    const Hyperplane floor{Vec4::UnitY(), -2};
    EXPECT_EQ(signed_distance(floor, {5, -2, 1, 1}), 0);
    EXPECT_EQ(signed_distance(floor, {5, 1, 1, 1}), 3);    // above: free
    EXPECT_EQ(signed_distance(floor, {5, -3, 1, 1}), -1);  // below: solid
}

TEST(Hyperplane, IsHitWhereTheRayMeetsItsBoundary) {
    RandomGeometry random(464);
    int hits = 0, misses = 0, inside = 0;
    for (int i = 0; i < 6000; ++i) {
        const Hyperplane plane = random_plane(random);
        const Vec4 o = random.in_box(Vec4::Constant(random.log_uniform(1, 1e5)));
        const Vec4 d = random.direction();
        const double t = ray_hit(plane, o, d);
        const LVec origin = o.cast<long double>();
        if (exact_distance(plane, origin) <= 0) {
            EXPECT_EQ(t, 0);
            ++inside;
        } else if (t == kMiss) {
            EXPECT_GE(d.dot(plane.normal), 0);
            ++misses;
        } else {
            const LVec hit = origin + t * d.cast<long double>();
            EXPECT_NEAR(double(exact_distance(plane, hit)), 0,
                        kRayAccuracy * (o.norm() + t + std::abs(plane.offset)));
            ++hits;
        }
    }
    EXPECT_GT(std::min({hits, misses, inside}), 1000);
    const Hyperplane floor;
    EXPECT_EQ(ray_hit(floor, {0, 2, 0, 0}, Vec4::UnitX()), kMiss);  // parallel, above
    EXPECT_EQ(ray_hit(floor, {0, 0, 0, 0}, Vec4::UnitY()), 0);      // on the boundary
    EXPECT_EQ(ray_hit(floor, {0, 2, 0, 0}, -Vec4::UnitY()), 2);
    EXPECT_EQ(ray_hit(floor, {0, 1e300, 0, 0}, Vec4(1, -1e-300, 0, 0)), kMiss);  // beyond double
}

TEST(Hyperplane, IsNeverNoNumber) {
    const double values[] = {0.0, -0.0, 1e-320, -1e-200, 1.0, -1e150, 1e200, -1e308};
    RandomGeometry random(465);
    for (int i = 0; i < 5000; ++i) {
        Hyperplane plane = random_plane(random);
        if (i % 2) plane.offset = values[random.engine() % std::size(values)];
        Vec4 p, d;
        for (double& x : p) x = values[random.engine() % std::size(values)];
        for (double& x : d) x = values[random.engine() % std::size(values)];
        EXPECT_FALSE(std::isnan(signed_distance(plane, p))) << p.transpose();
        if (d.isZero(0)) continue;
        EXPECT_GE(ray_hit(plane, p, stable_normalized(d)), 0) << p.transpose();
    }
}

}  // namespace
}  // namespace tesserae
