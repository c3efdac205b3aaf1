// SPDX-License-Identifier: Apache-2.0
#include "render/material/dielectric.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// A direction that meets a surface of the given normal from outside.
Vec4 incoming(Random& random, const Vec4& normal) {
    Vec4 d = random_direction(random);
    return d.dot(normal) > 0 ? Vec4(-d) : d;
}

TEST(Reflected, KeepsTheTangentAndTurnsTheNormalPart) {
    Random random(501);
    for (int i = 0; i < 1000; ++i) {
        const Vec4 n = random_direction(random), d = incoming(random, n);
        const Vec4 r = reflected(d, n);
        EXPECT_NEAR(r.norm(), 1, 1e-15);
        EXPECT_NEAR(r.dot(n), -d.dot(n), 1e-15);
        EXPECT_LT((r - r.dot(n) * n - (d - d.dot(n) * n)).norm(), 2e-15);
    }
}

TEST(Refracted, ObeysSnellsLawInThePlaneOfIncidence) {
    Random random(502);
    int total = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec4 n = random_direction(random), d = incoming(random, n);
        const double ratio = std::exp(uniform(random, -1, 1));
        const Vec4 across = d - d.dot(n) * n;
        const auto t = refracted(d, n, ratio);
        if (ratio * across.norm() >= 1) {
            EXPECT_FALSE(t);
            ++total;
            continue;
        }
        ASSERT_TRUE(t);
        EXPECT_NEAR(t->norm(), 1, 1e-15);
        EXPECT_LT(t->dot(n), 0);
        EXPECT_LT((*t - t->dot(n) * n - ratio * across).norm(), 1e-15 * (1 + ratio));
        // And back the same way. The square root that gives the cosine spreads roundings near the
        // critical angle.
        const auto back = refracted(-*t, -n, 1 / ratio);
        ASSERT_TRUE(back);
        EXPECT_LT((*back + d).norm(), 1e-13 / std::abs(d.dot(n)));
    }
    EXPECT_GT(total, 100);
}

TEST(Fresnel, HasItsKnownValues) {
    for (double n : {1.1, 1.5, 2.4}) {
        const double normal = std::pow((n - 1) / (n + 1), 2);
        EXPECT_NEAR(fresnel(1, 1 / n), normal, 1e-15);
        EXPECT_NEAR(fresnel(1, n), normal, 1e-15);
        EXPECT_NEAR(fresnel(0, 1 / n), 1, 1e-15);
        // Total reflection from the critical angle on.
        const double critical = std::sqrt(1 - 1 / (n * n));
        EXPECT_EQ(fresnel(critical - 1e-9, n), 1);
        EXPECT_LT(fresnel(critical + 1e-3, n), 1);
        // Brewster's angle, tan = n: no light polarised in the plane of incidence comes back, and
        // of the other two polarisations ((n^2 - 1)/(n^2 + 1))^2 each.
        const double brewster = 1 / std::sqrt(1 + n * n);
        EXPECT_NEAR(fresnel(brewster, 1 / n), 2.0 / 3 * std::pow((n * n - 1) / (n * n + 1), 2),
                    1e-15);
    }
    // No interface: the difference of two equal cosines, squared.
    EXPECT_NEAR(fresnel(0.3, 1), 0, 1e-30);
}

TEST(Fresnel, IsTheSameBothWays) {
    Random random(503);
    for (int i = 0; i < 1000; ++i) {
        const double n = uniform(random, 1, 3), sine = uniform(random, 0, 1) / n;
        const double outside = std::sqrt(1 - sine * sine * n * n),
                     inside = std::sqrt(1 - sine * sine);
        EXPECT_NEAR(fresnel(outside, 1 / n), fresnel(inside, n), 1e-13 / outside);
    }
}

}  // namespace
}  // namespace tesserae::render
