// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

template <class S>
struct ShapeRay : ::testing::Test {};
TYPED_TEST_SUITE(ShapeRay, BoundedShapes);

struct Line {
    LVec origin, direction;
    LVec at(long double t) const { return origin + t * direction; }
};

/// Where a ray comes nearest to a convex shape: the distance along it is convex, so golden sections
/// decide.
long double nearest_parameter(const Oracle& oracle, const Line& ray, long double end) {
    const auto distance = [&](long double t) { return oracle.signed_distance(ray.at(t)); };
    return least_of_convex(0, end, 110, distance).at;
}

/// Rays from `far` sizes away, aimed around the shape; some parallel to axes, some inside.
template <class S, class Check>
void for_rays(std::uint64_t seed, const Check& check) {
    RandomGeometry random(seed);
    for (const S& shape : sample_shapes<S>(random, 50)) {
        const Oracle oracle(shape);
        for (int i = 0; i < (std::derived_from<S, HullShape> ? 24 : 60); ++i) {
            const double far = i % 5 == 0 ? 1e4 : i % 5 == 1 ? 0.0 : random.log_uniform(0.5, 100);
            const Vec4 target = sample_point(shape, random);
            Vec4 d = random.direction();
            if (i % 3 == 0) d[random.engine() % 4] = 0;
            if (i % 7 == 0) d = Vec4::Unit(random.engine() % 4) * (i % 2 ? 1 : -1);
            d.normalize();
            const Vec4 o = target - far * oracle.size * d;
            check(shape, oracle, o, d, kRayAccuracy * (stable_norm(o) + oracle.size));
        }
    }
}

TYPED_TEST(ShapeRay, HitsTheZeroSetAndNothingBefore) {
    int hits = 0;
    for_rays<TypeParam>(431, [&](const auto& shape, const Oracle& oracle, const Vec4& o,
                                 const Vec4& d, double error) {
        const double t = ray_hit(shape, o, d);
        if (t == kMiss) return;
        ++hits;
        const Line ray = {o.cast<long double>(), d.cast<long double>()};
        const double start = double(oracle.signed_distance(ray.origin));
        if (t == 0) {
            EXPECT_LE(start, error);
            return;
        }
        EXPECT_GE(start, -error);
        EXPECT_NEAR(double(oracle.signed_distance(ray.at(t))), 0, error)
            << oracle.size << " o " << o.transpose() << " d " << d.transpose();
        for (int k = 1; k < 32; ++k) {
            EXPECT_GE(double(oracle.signed_distance(ray.at(t * (k / 32.0L)))), -error);
            EXPECT_GE(double(oracle.signed_distance(ray.at(t * (1 - std::pow(0.5L, k))))), -error);
        }
    });
    EXPECT_GT(hits, kShare<TypeParam> * 250);
}

TYPED_TEST(ShapeRay, MissesOnlyWhatItMisses) {
    int misses = 0;
    for_rays<TypeParam>(432, [&](const auto& shape, const Oracle& oracle, const Vec4& o,
                                 const Vec4& d, double error) {
        const Line ray = {o.cast<long double>(), d.cast<long double>()};
        // Beyond this the ray only goes away.
        const long double end = ray.origin.norm() + 2.0L * oracle.size;
        const long double nearest =
            oracle.signed_distance(ray.at(nearest_parameter(oracle, ray, end)));
        const bool hit = ray_hit(shape, o, d) < kMiss;
        misses += !hit;
        if (double(nearest) > error) {
            EXPECT_FALSE(hit);
        }
        if (double(nearest) < -error) {
            EXPECT_TRUE(hit) << o.transpose() << " d " << d.transpose();
        }
    });
    EXPECT_GT(misses, kShare<TypeParam> * 100);
}

/// From points inside and on the surface: inside up to the exit, which lies on the surface, and
/// outside from there on. Convexity leaves nothing else.
TYPED_TEST(ShapeRay, ExitsAtTheZeroSetAndNotBefore) {
    RandomGeometry random(434);
    int inward = 0;
    for (const auto& shape : sample_shapes<TypeParam>(random, 50)) {
        const Oracle oracle(shape);
        for (int i = 0; i < 60; ++i) {
            Vec4 d = random.direction();
            if (i % 3 == 0) d[random.engine() % 4] = 0;
            if (i % 7 == 0) d = Vec4::Unit(random.engine() % 4) * (i % 2 ? 1 : -1);
            d.normalize();
            // A point of the surface: where some ray hits. The next one goes in or out from there.
            const Vec4 aim = random.direction();
            const Vec4 far = -3 * oracle.size * aim;
            const double hit = ray_hit(shape, far, aim);
            if (hit == kMiss) continue;
            Vec4 o = far + hit * aim;
            if (i % 2 == 0) o *= random.log_uniform(1e-3, 1);
            const double error = 2 * kRayAccuracy * (stable_norm(far) + oracle.size);
            const double t = ray_exit(shape, o, d);
            ASSERT_GE(t, 0);
            ASSERT_LE(t, 2 * oracle.size * (1 + 1e-12) + error);
            const Line ray = {o.cast<long double>(), d.cast<long double>()};
            inward += t > 0.01 * oracle.size;
            EXPECT_NEAR(double(oracle.signed_distance(ray.at(t))), 0, t > 0 ? error : kMiss)
                << oracle.size << " o " << o.transpose() << " d " << d.transpose();
            for (int k = 0; k <= 16; ++k)
                EXPECT_LE(double(oracle.signed_distance(ray.at(t * (k / 16.0L)))), error);
            // Beyond it the distance grows: a hundredth of a size farther the ray is outside by
            // more than it was, or on the flat face along which it runs.
            const double beyond = double(oracle.signed_distance(ray.at(t + 0.01L * oracle.size)));
            EXPECT_GE(beyond, -error)
                << oracle.size << " o " << o.transpose() << " d " << d.transpose();
        }
    }
    EXPECT_GT(inward, kShare<TypeParam> * 1000);
}

/// One ray in so many.
template <class S>
void expect_sphere_tracing(int every) {
    int number = 0, compared = 0;
    for_rays<S>(433, [&](const auto& shape, const Oracle& oracle, const Vec4& o, const Vec4& d,
                         double error) {
        if (++number % every != 0) return;
        const double t = ray_hit(shape, o, d);
        if (t == kMiss) return;
        const Line ray = {o.cast<long double>(), d.cast<long double>()};
        long double traced = 0, distance = 0;
        for (int step = 0; step < kShare<S> * 2000; ++step) {
            distance = oracle.signed_distance(ray.at(traced));
            if (distance < 1e-17L * oracle.size) break;
            traced += distance;
            if (traced > ray.origin.norm() + 2 * oracle.size) break;
        }
        if (distance >= 1e-17L * oracle.size) return;
        // Along the ray an error of the surface counts by the secant of the angle of incidence.
        const Vec4 n = normal(shape, ray.at(traced).template cast<double>());
        const double cosine = std::abs(n.dot(d));
        if (cosine < 0.05) return;
        ++compared;
        EXPECT_NEAR(t, double(traced), 2 * error / cosine)
            << oracle.size << " o " << o.transpose() << " d " << d.transpose();
        EXPECT_NEAR(t, double(traced), 1e-9 * std::max(double(traced), oracle.size));
    });
    EXPECT_GT(compared, kShare<S> * 150 / every);
}

TYPED_TEST(ShapeRay, AgreesWithSphereTracing) {
    // The oracle of a hull takes long.
    expect_sphere_tracing<TypeParam>(std::derived_from<TypeParam, HullShape> ? 3 : 1);
}

template <class S>
struct ShapeRaySlow : ::testing::Test {};
using HullShapes = ::testing::Types<Polychoron, Duoprism>;
TYPED_TEST_SUITE(ShapeRaySlow, HullShapes);

TYPED_TEST(ShapeRaySlow, AgreesWithSphereTracing) { expect_sphere_tracing<TypeParam>(1); }

TYPED_TEST(ShapeRay, StartsOnTheSurfaceAndLeavesOrEnters) {
    RandomGeometry random(434);
    for (const TypeParam& shape : sample_shapes<TypeParam>(random, 50))
        for (int i = 0; i < 40; ++i) {
            Vec4 p = sample_point(shape, random);
            p -= signed_distance(shape, p) * normal(shape, p);
            const Vec4 n = normal(shape, p), d = random.direction();
            if (std::abs(n.dot(d)) < 1e-3) continue;
            const double t = ray_hit(shape, p, d);
            const double size = bounding_radius(shape);
            // Outward: never again, if p is not within by rounding; between cells it may go along
            // one of them.
            const bool is_outward = signed_distance(shape, p + 1e-3 * size * d) > 1e-6 * size;
            if (n.dot(d) > 0 && signed_distance(shape, p) > 0 &&
                (is_outward || !std::derived_from<TypeParam, HullShape>)) {
                EXPECT_EQ(t, kMiss) << p.transpose();
            }
            // Inward: at once. The distance is convex: from rounding at p to less than -1e-6 size
            // at 1e-3 size it is zero before 1e3 times that rounding.
            if (signed_distance(shape, p + 1e-3 * size * d) < -1e-6 * size) {
                EXPECT_LE(t, 2e3 * kRayAccuracy * size) << p.transpose();
            }
            if (signed_distance(shape, p) <= 0) {
                EXPECT_EQ(t, 0) << p.transpose();
            }
        }
}

TYPED_TEST(ShapeRay, GrazesWithinRounding) {
    // Rays tangent to the shape, moved off or into it by far more than rounding: miss and hit.
    RandomGeometry random(435);
    for (const TypeParam& shape : sample_shapes<TypeParam>(random, 50))
        for (int i = 0; i < 40; ++i) {
            const Vec4 n = random.direction(), surface = support(shape, n);
            Vec4 d = random.direction();
            d = (d - d.dot(n) * n).normalized();
            const double size = bounding_radius(shape);
            const double far = random.log_uniform(0.1, 1e4) * size;
            const double off = 2e-15 * (far + 2 * size);
            const auto start = [&](double s) -> Vec4 { return surface + s * n - far * d; };
            EXPECT_EQ(ray_hit(shape, start(2 * off), d), kMiss);
            // A ray that is that much under a sharp corner may be nearer to the faces beside it.
            if (!std::derived_from<TypeParam, HullShape> ||
                signed_distance(shape, surface - 2 * off * n) < -2 * kRayAccuracy * (far + size)) {
                EXPECT_LT(ray_hit(shape, start(-2 * off), d), kMiss);
            }
        }
}

}  // namespace
}  // namespace tesserae
