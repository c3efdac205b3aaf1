// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/cap.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

using std::numbers::pi;

Uniform3 uniforms(Random& random) {
    return {uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
}

/// A sum of n values' mean, within 5 deviations of the expected one.
void expect_mean(double sum, double sum_of_squares, int n, double expected, const char* what) {
    const double mean = sum / n;
    const double sigma = std::sqrt(std::max(0.0, sum_of_squares / n - mean * mean) / n);
    EXPECT_NEAR(mean, expected, 5 * sigma + 1e-12) << what;
}

TEST(TangentFrame, IsOrthonormalAndKeepsTheAxis) {
    Random random(301);
    for (int i = 0; i < 1000; ++i) {
        const Vec4 axis =
            i < 8 ? Vec4((i % 2 ? -1 : 1) * Vec4::Unit(i / 2)) : random_direction(random);
        const TangentFrame frame(axis);
        // Reflections of unit vectors: some ten roundings of 1.1e-16 each, twice for the way back.
        EXPECT_LT((frame.to_world(Vec4::UnitW()) - axis).norm(), 1e-15);
        const Vec4 a = random_direction(random), b = random_direction(random);
        EXPECT_NEAR(frame.to_world(a).dot(frame.to_world(b)), a.dot(b), 2e-15);
        EXPECT_LT((frame.to_local(frame.to_world(a)) - a).norm(), 2e-15);
    }
}

TEST(CosineDirection, HasTheMomentsOfItsDensity) {
    // Under 3 cos/(4 pi) on the hemisphere: E[cos^k] = 3 * integral of sin^2 cos^(k+1) over the
    // quarter turn, which is 1 for k = 0, 3 pi/16 for k = 1, 2/5 for k = 2. Tangents: E[x^2] = 1/5.
    Random random(302);
    constexpr int kCount = 200'000;
    double sum = 0, square = 0, sum2 = 0, square2 = 0, sumx = 0, squarex = 0;
    for (int i = 0; i < kCount; ++i) {
        const Vec4 d = cosine_direction(uniforms(random));
        ASSERT_NEAR(d.norm(), 1, 1e-14);
        ASSERT_GE(d[3], 0);
        sum += d[3], square += d[3] * d[3];
        sum2 += d[3] * d[3], square2 += std::pow(d[3], 4);
        sumx += d[0] * d[0], squarex += std::pow(d[0], 4);
    }
    expect_mean(sum, square, kCount, 3 * pi / 16, "cos");
    expect_mean(sum2, square2, kCount, 0.4, "cos^2");
    expect_mean(sumx, squarex, kCount, 0.2, "x^2");
}

TEST(CapSolidAngle, MatchesItsFormulaAndItsSeries) {
    for (double angle : {0.3, 0.49999, 0.50001, 1.0, pi / 2, 3.0, pi}) {
        const double expected = 2 * pi * (angle - std::sin(angle) * std::cos(angle));
        // The formula itself cancels at small angles: 4 roundings of the angle.
        EXPECT_NEAR(cap_solid_angle(angle), expected, 2 * pi * 4 * 2.3e-16 * angle) << angle;
    }
    EXPECT_NEAR(cap_solid_angle(pi), 2 * pi * pi, 1e-14);
    // Small: a 3-ball of that radius, less a relative angle^2/5.
    for (double angle : {1e-8, 1e-4, 1e-3}) {
        const double ball = 4 * pi / 3 * angle * angle * angle;
        EXPECT_NEAR(cap_solid_angle(angle) / ball, 1 - angle * angle / 5, 1e-12) << angle;
    }
}

TEST(CapDirection, InvertsItsDistribution) {
    // The part of the cap within the angle that was returned is the number that went in.
    for (double angle : {1e-7, 0.01, 0.3, 1.0, 1.4, pi / 2})
        for (int i = 1; i < 1000; ++i) {
            const double u = i / 1000.0;
            const Vec4 d = Cap(angle).direction({u, 0.3, 0.7});
            const double polar = std::atan2(d.head<3>().norm(), d[3]);
            ASSERT_LE(polar, angle * (1 + 1e-14));
            // atan2 and the sine keep 1e-15 of the angle, whose cube root u is.
            ASSERT_NEAR(cap_solid_angle(polar) / cap_solid_angle(angle), u, 1e-13) << angle;
        }
}

TEST(CapDirection, FillsTheCapEvenly) {
    // Chi-squared over 10 shells of equal solid angle x 8 octants of the tangent directions: 79
    // degrees of freedom, deviation sqrt(158) = 12.6.
    Random random(303);
    for (double angle : {1e-3, 0.2, 1.5}) {
        std::vector<double> count(80);
        constexpr int kCount = 80'000;
        for (int i = 0; i < kCount; ++i) {
            const Vec4 d = Cap(angle).direction(uniforms(random));
            ASSERT_NEAR(d.norm(), 1, 1e-14);
            const double polar = std::atan2(d.head<3>().norm(), d[3]);
            const int shell =
                std::min(9, static_cast<int>(10 * cap_solid_angle(polar) / cap_solid_angle(angle)));
            const int octant = (d[0] > 0) + 2 * (d[1] > 0) + 4 * (d[2] > 0);
            ++count[static_cast<std::size_t>(8 * shell + octant)];
        }
        double chi = 0;
        for (double c : count) chi += (c - 1000) * (c - 1000) / 1000;
        EXPECT_NEAR(chi, 79, 5 * 12.6) << angle;
    }
}

/// Uniform numbers, and the ends of [0, 1) in between.
Uniform3 any_uniforms(Random& random, int i) {
    Uniform3 u = uniforms(random);
    constexpr double kEnds[] = {0, 0x1p-32, 0.25, 0.5, 0.75, 1 - 0x1p-32};
    if (i % 2) u[static_cast<std::size_t>(i / 2 % 3)] = kEnds[i / 6 % 6];
    return u;
}

TEST(Directions, FourAtOnceAreThoseOfEach) {
    Random random(304);
    for (int i = 0; i < 2000; ++i) {
        std::array<Uniform3, 4> u;
        FourUniform3 four;
        for (std::size_t k = 0; k < 4; ++k) {
            u[k] = any_uniforms(random, 4 * i + static_cast<int>(k));
            for (std::size_t n = 0; n < 3; ++n) four[n][k] = u[k][n];
        }
        const Cap cap(std::pow(10, uniform(random, -9, std::log10(pi / 2))));
        const TangentFrame frame(random_direction(random));
        const FourDirections cosines = cosine_directions(four), in_cap = cap.directions(four);
        const FourDirections world = frame.to_world(in_cap);
        for (std::size_t k = 0; k < 4; ++k) {
            ASSERT_EQ(cosines[k], cosine_direction(u[k])) << i;
            ASSERT_EQ(in_cap[k], cap.direction(u[k])) << i;
            // The sums of products may be taken in another order.
            ASSERT_LT((world[k] - frame.to_world(in_cap[k])).norm(), 1e-15) << i;
            ASSERT_NEAR(in_cap[k].norm(), 1, 1e-15);
            ASSERT_NEAR(cosines[k].norm(), 1, 1e-15);
        }
    }
}

TEST(Directions, AreWhereTheLibrarysFunctionsPutThem) {
    Random random(305);
    for (int i = 0; i < 20000; ++i) {
        const Uniform3 u = any_uniforms(random, i);
        // From the third axis, and round it: half a turn on from the first.
        const double longitude = 2 * pi * u[2] - pi, z = 1 - 2 * u[1];
        const double radius = std::cbrt(u[0]), across = std::sqrt(1 - z * z);
        const Eigen::Vector3d ball =
            radius * Eigen::Vector3d(across * std::cos(longitude), across * std::sin(longitude), z);
        // Where sine or cosine turn round, their angle is known to the root of a rounding.
        ASSERT_LT((uniform_ball(u) - ball).norm(), 5e-8) << i;
        ASSERT_NEAR(uniform_ball(u).norm(), radius, 1e-13) << i;
        ASSERT_LT((cosine_direction(u).head<3>() - ball).norm(), 5e-8) << i;
    }
}

/// Irradiance by quadrature over the cap: midpoints in the polar angle and in the angle from the
/// direction of steepest ascent, on which alone the cosine depends.
double irradiance_by_quadrature(double angle, double altitude) {
    constexpr int kSteps = 2000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double polar = angle * (i + 0.5) / kSteps;
        double ring = 0;
        for (int j = 0; j < kSteps; ++j) {
            // z is uniform on a 2-sphere of tangent directions.
            const double z = -1 + 2 * (j + 0.5) / kSteps;
            ring += std::max(0.0, std::cos(polar) * std::sin(altitude) +
                                      std::sin(polar) * z * std::cos(altitude));
        }
        sum += 4 * pi * std::sin(polar) * std::sin(polar) * ring / kSteps;
    }
    return sum * angle / kSteps;
}

TEST(CapIrradiance, MatchesQuadratureAboveAndAcrossTheHorizon) {
    for (double angle : {0.05, 0.4, 1.0, 1.5})
        for (double part : {-0.99, -0.5, -0.1, 0.0, 0.3, 0.9, 1.0, 1.04}) {
            const double altitude = std::min(part * angle, pi / 2);
            const double expected = irradiance_by_quadrature(angle, altitude);
            // Midpoints miss by the square of a step times the kink: 1e-6 of the whole cap's.
            const double whole = 4 * pi / 3 * std::pow(std::sin(angle), 3);
            EXPECT_NEAR(cap_irradiance(angle, altitude), expected, 2e-6 * whole)
                << angle << " " << altitude;
        }
    EXPECT_EQ(cap_irradiance(0.3, -0.31), 0);
}

TEST(CapIrradiance, IsContinuousWhereItsFormulasMeet) {
    for (double angle : {1e-6, 1e-3, 0.1, 1.0, 1.57}) {
        const double up = cap_irradiance(angle, angle);
        EXPECT_NEAR(cap_irradiance(angle, angle * (1 - 1e-9)) / up, 1, 1e-8) << angle;
        EXPECT_NEAR(cap_irradiance(angle, -angle * (1 - 1e-9)) / up, 0, 1e-8) << angle;
        // Half set: the ball's half and the flat rim, in between and growing with the altitude.
        double last = 0;
        for (int i = -99; i <= 99; ++i) {
            const double e = cap_irradiance(angle, angle * i / 100);
            EXPECT_GT(e, last) << angle << " " << i;
            last = e;
        }
    }
}

}  // namespace
}  // namespace tesserae::render
