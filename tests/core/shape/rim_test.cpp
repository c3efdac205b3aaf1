// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/core/shape/oracle.hpp"

namespace tesserae {
namespace {

template <class S>
struct ShapeRim : ::testing::Test {};
TYPED_TEST_SUITE(ShapeRim, BoundedShapes);

template <class S>
struct ShapeRimSlow : ::testing::Test {};
TYPED_TEST_SUITE(ShapeRimSlow, BoundedShapes);

/// The definition, in long double: the least s f(1/s) over s >= 1/limit, a convex function of s, by
/// golden section. Beyond s = 2/f(0) it is above 1, as f falls by no more than t.
long double least_ratio(const Oracle& oracle, const Vec4& origin, const Vec4& direction,
                        double limit) {
    const LVec o = origin.cast<long double>(), d = direction.cast<long double>();
    const long double start = oracle.signed_distance(o), first = 1 / (long double)limit;
    const auto ratio = [&](long double s) {
        return s > 0 ? s * oracle.signed_distance(o + d / s) : 1;
    };
    return least_of_convex(first, std::max(first, 2 / start), 100, ratio).value;
}

/// A unit direction from `origin` past or through the shape: at any of its points, or past its
/// outline; every fourth with zeros, so along faces, edges and the core.
template <class S>
Vec4 aimed_direction(const S& shape, const Vec4& origin, RandomGeometry& random) {
    const Vec4 half = half_extents(shape, Mat4::Identity());
    Vec4 d = random.in_box(half);
    const double kind = random.uniform(0, 1);
    if (kind < 0.5) d = support(shape, random.direction());
    if (kind < 0.2) d *= random.uniform(0.9, 1.3);
    d -= origin;
    if (random.uniform(0, 1) < 0.25)
        for (double& x : d)
            if (random.uniform(0, 1) < 0.5) x = random.uniform(0, 1) < 0.5 ? 0.0 : -0.0;
    if (random.uniform(0, 1) < 0.1) d = -d;
    return d.isZero(0) ? Vec4(Vec4::UnitZ()) : stable_normalized(d);
}

/// Calls check(shape, oracle, origin, direction, error bound) for starts outside: near, on the
/// planes of faces, far away, a hair off the surface.
template <class S, class Check>
void for_rays(std::uint64_t seed, std::size_t shapes, const Check& check) {
    RandomGeometry random(seed);
    for (const S& shape : sample_shapes<S>(random, shapes)) {
        const Oracle oracle(shape);
        for (int i = 0; i < (std::derived_from<S, HullShape> ? 24 : 60); ++i) {
            Vec4 o = sample_point(shape, random);
            if (i % 3 == 0) o *= random.log_uniform(1, 1e4);
            if (i % 5 == 0) {
                o = support(shape, random.direction());
                o += random.log_uniform(1e-9, 1) * oracle.size * normal(shape, o);
            }
            if (i % 7 == 0) o[i % 4] = half_extents(shape, Mat4::Identity())[i % 4];
            const double distance = signed_distance(shape, o);
            if (distance <= 1e-10 * oracle.size) continue;
            check(shape, oracle, o, aimed_direction(shape, o, random),
                  kRimAccuracy * (stable_norm(o) + oracle.size) / distance, random);
        }
    }
}

template <class S>
void expect_least_ratio(std::size_t shapes) {
    int passing = 0, entering = 0, clear = 0;
    for_rays<S>(431, shapes,
                [&](const auto& shape, const Oracle& oracle, const Vec4& o, const Vec4& d,
                    double error, RandomGeometry&) {
                    const double expected = double(least_ratio(oracle, o, d, kMiss));
                    EXPECT_NEAR(rim(shape, o, d, {}).sine, expected, error)
                        << o.transpose() << ", " << d.transpose();
                    (expected < 0 ? entering : expected < 1 ? passing : clear) += 1;
                });
    EXPECT_GT(passing, kShare<S> * 25 / 9 * static_cast<double>(shapes));
    EXPECT_GT(entering, kShare<S> * 25 / 9 * static_cast<double>(shapes));
    EXPECT_GT(clear, kShare<S> * 25 / 90 * static_cast<double>(shapes));
}

TYPED_TEST(ShapeRim, IsTheLeastRatioOfDistanceAlongTheRay) { expect_least_ratio<TypeParam>(60); }
TYPED_TEST(ShapeRimSlow, IsTheLeastRatioOfDistanceAlongTheRay) {
    expect_least_ratio<TypeParam>(120);
}

template <class S>
void expect_counts_before_limit(std::size_t shapes) {
    int cut = 0;
    for_rays<S>(
        432, shapes,
        [&](const auto& shape, const Oracle& oracle, const Vec4& o, const Vec4& d, double error,
            RandomGeometry& random) {
            const double limit = random.log_uniform(0.01, 1.5) * (stable_norm(o) + oracle.size);
            // Behind it may be said to be clear.
            const double expected = std::min(1.0, double(least_ratio(oracle, o, d, limit)));
            EXPECT_NEAR(std::min(1.0, rim(shape, o, d, {-1, 1, limit}).sine), expected, error)
                << o.transpose() << ", " << d.transpose() << ", " << limit;
            cut += expected < 0.9 && expected > rim(shape, o, d, {}).sine + error;
        });
    EXPECT_GT(cut, kShare<S> * 5 / 6 * static_cast<double>(shapes));
}

TYPED_TEST(ShapeRim, CountsWhatComesBeforeTheLimitOnly) {
    expect_counts_before_limit<TypeParam>(60);
}
TYPED_TEST(ShapeRimSlow, CountsWhatComesBeforeTheLimitOnly) {
    expect_counts_before_limit<TypeParam>(120);
}

TYPED_TEST(ShapeRim, KeepsItsBitsInAnyRangeThatHoldsIt) {
    for_rays<TypeParam>(433, 120,
                        [&](const auto& shape, const Oracle&, const Vec4& o, const Vec4& d,
                            double error, RandomGeometry& random) {
                            const double sine = rim(shape, o, d, {}).sine;
                            for (int i = 0; i < 4; ++i) {
                                const double low = -random.log_uniform(1e-6, 1),
                                             high = random.uniform(low, -low);
                                const double found = rim(shape, o, d, {low, high}).sine;
                                // At the very ends rounding may tell either side.
                                if (sine > low + error && sine < high - error) {
                                    EXPECT_EQ(found, sine);
                                } else if (sine <= low) {
                                    EXPECT_LE(found, low + error);
                                } else if (sine >= high) {
                                    EXPECT_GE(found, high - error);
                                }
                            }
                            // Of a point the sign is all there is.
                            const double hard = rim(shape, o, d, {0, 0}).sine;
                            if (std::abs(sine) > error) {
                                EXPECT_EQ(hard < 0, sine < 0);
                            }
                        });
}

TYPED_TEST(ShapeRim, HasTheSignOfTheHit) {
    for_rays<TypeParam>(434, 300,
                        [&](const auto& shape, const Oracle&, const Vec4& o, const Vec4& d,
                            double error, RandomGeometry&) {
                            const double sine = rim(shape, o, d, {}).sine;
                            if (std::abs(sine) > error) {
                                EXPECT_EQ(ray_hit(shape, o, d) < kMiss, sine < 0);
                            }
                        });
}

TYPED_TEST(ShapeRim, FromInsideIsAllOrTheTangentHalfSpace) {
    RandomGeometry random(435);
    for (const TypeParam& shape : sample_shapes<TypeParam>(random, 60)) {
        const double size = bounding_radius(shape);
        for (int i = 0; i < 40; ++i) {
            const Vec4 p = sample_point(shape, random), d = random.direction();
            const Vec4 n = normal(shape, p);
            const double depth = signed_distance(shape, p);
            if (depth < -1e-6 * size) {
                EXPECT_EQ(rim(shape, p, d, {}).sine, -1);
            }
            if (depth > 0) continue;
            // Pushed out to the surface and, within a few roundings, back in.
            const Vec4 surface = p - (depth + random.uniform(0, 1) * 1e-13 * size) * n;
            if (signed_distance(shape, surface) > 0) continue;
            EXPECT_NEAR(rim(shape, surface, d, {}).sine, normal(shape, surface).dot(d), 1e-15);
        }
    }
}

TYPED_TEST(ShapeRim, IsNeverNoNumber) {
    const double values[] = {0.0, -0.0, 5e-324, 1e-320, -1e-200, 1e-150, 1.0, -1e150, 1e200, 1e307};
    const double limits[] = {5e-324, 1e-200, 1, 1e200, kMiss};
    RandomGeometry random(436);
    for (const TypeParam& shape : odd_shapes<TypeParam>())
        for (int i = 0; i < 3000; ++i) {
            Vec4 p, d;
            for (double& x : p) x = values[random.engine() % std::size(values)];
            for (double& x : d) x = values[random.engine() % std::size(values)];
            if (i % 4 == 0) p[i / 4 % 4] = half_extents(shape, Mat4::Identity())[i / 4 % 4];
            if (d.isZero(0)) continue;
            const RimRange range = {-0.01, 0.02, limits[random.engine() % std::size(limits)]};
            EXPECT_FALSE(std::isnan(rim(shape, p, stable_normalized(d), range).sine))
                << p.transpose() << ", " << d.transpose();
        }
}

TEST(BoxRim, TakesFewSteps) {
    // Told to the last bit, grazing rays and all: the second step confirms the first for most, and
    // none uses up the 60 of which the last 50 are halvings.
    int count = 0, steps = 0, most = 0;
    for_rays<Hyperbox>(437, 300,
                       [&](const auto& shape, const Oracle&, const Vec4& o, const Vec4& d, double,
                           RandomGeometry&) {
                           const int taken = rim(shape, o, d, {}).steps;
                           if (taken == 0) return;
                           ++count, steps += taken, most = std::max(most, taken);
                       });
    EXPECT_GT(count, 5000);
    EXPECT_LT(double(steps) / count, 3.5);
    EXPECT_LT(most, 60);
}

TEST(PlaneRim, IsItsHorizon) {
    const Hyperplane plane{Vec4::UnitY(), -2};
    const Vec4 d(0.8, -0.6, 0, 0), o(5, 1, 0, 0);
    EXPECT_EQ(rim(plane, o, d, {}).sine, -0.6);
    EXPECT_EQ(rim(plane, o, -d, {}).sine, 0.6);
    EXPECT_DOUBLE_EQ(rim(plane, o, d, {-1, 1, 10}).sine, -0.6 + 3.0 / 10);
    EXPECT_EQ(rim(plane, {5, -2, 0, 0}, d, {}).sine, -0.6);
    EXPECT_EQ(rim(plane, {5, -3, 0, 0}, -d, {}).sine, -1);
}

TEST(CapsuleRim, OfNoCoreIsTheBalls) {
    RandomGeometry random(438);
    for (int i = 0; i < 2000; ++i) {
        const double radius = random.log_uniform(0.1, 10);
        const Vec4 o = random.uniform(1.01, 10) * radius * random.direction();
        const Vec4 d = random.direction();
        EXPECT_EQ(rim(Hypercapsule{radius, 0}, o, d, {}).sine,
                  rim(Hypersphere{radius}, o, d, {}).sine);
    }
}

}  // namespace
}  // namespace tesserae
