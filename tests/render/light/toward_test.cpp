// SPDX-License-Identifier: Apache-2.0
#include "render/light/toward.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// Sum over samples of a number and its deviation.
struct Average {
    double sum = 0, square = 0;
    int count = 0;

    void add(double x) { sum += x, square += x * x, ++count; }
    double mean() const { return sum / count; }
    double sigma() const {
        return std::sqrt(std::max(0.0, square / count - mean() * mean()) / (count - 1));
    }
};

/// Points outside a shape: near its surface, at some sizes, far; beside flat sides and past ends.
Vec4 somewhere_outside(Random& random, const Shape& shape, int i) {
    const double size = bounding_radius(shape);
    for (;;) {
        const double far = std::pow(10, uniform(random, i % 3 == 0 ? -2 : 0, i % 3 == 2 ? 4 : 1));
        Vec4 point = random_direction(random) * (size * (1 + far));
        if (i % 4 == 1) point[1] *= 0.01;
        if (i % 4 == 2) point[0] *= 1e-3, point[2] *= 1e-3, point[3] *= 1e-3;
        if (std::visit([&](const auto& s) { return signed_distance(s, point); }, shape) > 0)
            return point;
    }
}

bool is_met(const Shape& shape, const Vec4& origin, const Vec4& direction) {
    return std::visit([&](const auto& s) { return ray_hit(s, origin, direction); }, shape) < kMiss;
}

Uniform3 three(Random& random) {
    return {uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
}

void expect_integrals_toward_shapes(int shapes) {
    // Of 1, x and x^2 along a random axis, against uniform directions of the bounding ball's cap.
    Random random(531);
    for (int i = 0; i < shapes; ++i) {
        const Shape shape = random_shape(random, i % kShapeKinds, 1);
        const Vec4 origin = somewhere_outside(random, shape, i / 3);
        const double sine = std::min(1.0, bounding_radius(shape) / origin.norm());
        const double angle = std::asin(sine), cap = cap_solid_angle(angle);
        const TangentFrame frame(-origin.normalized());
        const Vec4 axis = random_direction(random);
        std::array<Average, 3> found, expected;
        for (int k = 0; k < 20'000; ++k) {
            const Uniform3 u = three(random);
            const auto toward = sample_toward(shape, origin, u);
            const Vec4 any = frame.to_world(Cap(angle).direction(u));
            const bool meets = toward && is_met(shape, origin, toward->direction);
            const double at = meets ? 1 / (toward->density * cap) : 0;
            const double x = meets ? (toward->direction + origin.normalized()).dot(axis) / sine : 0;
            const double y = (any + origin.normalized()).dot(axis) / sine;
            double found_at = at, expected_at = is_met(shape, origin, any);
            for (std::size_t n = 0; n < 3; ++n, found_at *= x, expected_at *= y)
                found[n].add(found_at), expected[n].add(expected_at);
        }
        for (std::size_t n = 0; n < 3; ++n) {
            const double sigma = std::hypot(found[n].sigma(), expected[n].sigma());
            EXPECT_NEAR(found[n].mean(), expected[n].mean(), 5 * sigma + 1e-9) << i << ' ' << n;
        }
        EXPECT_LT(found[0].sigma(), 0.05) << i;
    }
}

TEST(Toward, IntegratesOverTheDirectionsThatMeetTheShape) { expect_integrals_toward_shapes(20); }
TEST(TowardSlow, IntegratesOverTheDirectionsThatMeetTheShape) {
    expect_integrals_toward_shapes(60);
}

TEST(Toward, IsNearlyEvenInSolidAngle) {
    // The relative variance of the inverse density: what the choice alone adds to a light's noise.
    // Most of 30 at 2, 4 and 10 bounding radii: capsules 0.01, 0.003, 6e-9, boxes 0.09, 0.002,
    // 2e-4.
    Random random(535);
    const double most[3][3] = {{1e-12, 1e-12, 1e-12}, {0.02, 0.006, 1e-6}, {0.15, 0.005, 4e-4}};
    for (int i = 0; i < 90; ++i) {
        const int kind = i % 3, far = i / 3 % 3;
        const Shape shape = random_shape(random, kind, 1);
        const double radii[] = {2, 4, 10};
        const Vec4 origin = random_direction(random) * (radii[far] * bounding_radius(shape));
        Average inverse;
        for (int k = 0; k < 2000; ++k) {
            const auto toward = sample_toward(shape, origin, three(random));
            ASSERT_TRUE(toward);
            inverse.add(is_met(shape, origin, toward->direction) ? 1 / toward->density : 0);
        }
        const double deviation = inverse.sigma() * std::sqrt(inverse.count) / inverse.mean();
        EXPECT_LT(deviation * deviation, most[kind][far]) << i;
    }
}

TEST(Toward, DensityIsThatOfTheSample) {
    Random random(532);
    int met = 0, missed = 0;
    for (int i = 0; i < 3000; ++i) {
        const bool is_exact = i % kShapeKinds < 3;
        const Shape shape = random_shape(random, i % kShapeKinds, 1);
        const Vec4 origin = somewhere_outside(random, shape, i / 3);
        const auto toward = sample_toward(shape, origin, three(random));
        ASSERT_TRUE(toward) << i;
        ASSERT_NEAR(toward->direction.norm(), 1, 1e-12);
        ASSERT_GT(toward->density, 0);
        const bool is_hit = is_met(shape, origin, toward->direction);
        met += is_hit, missed += is_exact && !is_hit;
        if (!is_hit) continue;
        const double density = density_toward(shape, origin, toward->direction);
        // Far away or at grazing incidence the digits of where it is met go.
        EXPECT_NEAR(density / toward->density, 1, 1e-5) << i;
    }
    // Balls, capsules and boxes but for rounding; the others by chance.
    EXPECT_LT(missed, 20);
    EXPECT_GT(met, 1700);
}

TEST(Toward, NothingFromInside) {
    Random random(533);
    for (int i = 0; i < 300; ++i) {
        const Shape shape = random_shape(random, i % kShapeKinds, 1);
        const Vec4 direction = random_direction(random);
        const Vec4 inside = 0.01 * random_direction(random);
        EXPECT_FALSE(sample_toward(shape, inside, three(random)));
        EXPECT_EQ(density_toward(shape, inside, direction), 0);
    }
}

TEST(Toward, ThinAndFarShapesGiveFiniteNumbers) {
    Random random(534);
    for (int i = 0; i < 4000; ++i) {
        const auto extreme = [&] { return std::pow(10, uniform(random, -9, 9)); };
        Shape shape = Hypercapsule{extreme(), extreme()};
        if (i % 2 == 0) shape = Hyperbox{{extreme(), extreme(), extreme(), extreme()}};
        const Vec4 origin = random_direction(random) * extreme();
        const auto toward = sample_toward(shape, origin, three(random));
        if (toward) {
            ASSERT_NEAR(toward->direction.norm(), 1, 1e-9) << i;
            ASSERT_TRUE(std::isfinite(toward->density) && toward->density > 0) << i;
        }
        const double density = density_toward(shape, origin, random_direction(random));
        ASSERT_TRUE(std::isfinite(density) && density >= 0) << i;
    }
}

}  // namespace
}  // namespace tesserae::render
