// SPDX-License-Identifier: Apache-2.0
#include "render/material/microfacet.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/render/sphere_quadrature.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

constexpr double kRoughnesses[] = {0.4, 0.6, 1.0};

TEST(Microfacet, ProjectedAreaOfTheMirrorsIsOne) {
    for (double roughness : {0.01, 0.05, 0.3, 0.7, 1.0}) {
        const Microfacet facets(roughness);
        // With tan(polar) = alpha s, alpha = roughness^2, the lobe is of size 1 in s.
        const double alpha = std::max(Microfacet::kLeastAlpha, roughness * roughness);
        double sum = 0;
        constexpr int kSteps = 200'000;
        for (int i = 0; i < kSteps; ++i) {
            const double v = (i + 0.5) / kSteps, s = v / (1 - v);
            const double polar = std::atan(alpha * s), cosine = std::cos(polar);
            sum += facets.normal_density(direction_at(polar, 0.3)) * cosine * 4 * pi *
                   std::pow(std::sin(polar), 2) * alpha * cosine * cosine / ((1 - v) * (1 - v));
        }
        EXPECT_NEAR(sum / kSteps, 1, 1e-8) << roughness;
    }
}

TEST(Microfacet, MirrorsSeenFillWhatIsSeenOfTheSurface) {
    // Integral of G1(v) max(0, v.m) D(m) = cos v, for every v: what defines G1. Midpoints at the
    // kink v.m = 0 leave 1e-5.
    for (double roughness : kRoughnesses)
        for (double polar : {0.1, 0.8, 1.3, 1.5}) {
            const Microfacet facets(roughness);
            const Vec4 v = direction_at(polar, 0);
            const double area = integral(
                [&](const Vec4& m) { return std::max(0.0, v.dot(m)) * facets.normal_density(m); },
                0, pi / 2, 0, pi, 700);
            EXPECT_NEAR(facets.visible_part(v) * area, std::cos(polar), 2e-5)
                << roughness << " " << polar;
        }
}

TEST(Microfacet, IsReciprocal) {
    Random random(511);
    for (int i = 0; i < 2000; ++i) {
        const Microfacet facets(uniform(random, 0.05, 1));
        Vec4 a = random_direction(random), b = random_direction(random);
        a[3] = std::abs(a[3]), b[3] = std::abs(b[3]);
        const double there = facets.brdf(a, b);
        EXPECT_GT(there, 0);
        EXPECT_NEAR(facets.brdf(b, a), there, 1e-13 * there);
    }
    EXPECT_EQ(Microfacet(0.5).brdf(Vec4::UnitW(), Vec4(1, 0, 0, 0)), 0);
}

double albedo_of(const Microfacet& facets, const Vec4& out) {
    return albedo_by_quadrature([&](const Vec4& in) { return facets.brdf(out, in); });
}

TEST(Microfacet, SendsBackNoMoreThanItGets) {
    for (double roughness : kRoughnesses)
        for (double polar : {0.05, 0.7, 1.2, 1.5}) {
            const Microfacet facets(roughness);
            const double albedo = albedo_of(facets, direction_at(polar, 0));
            EXPECT_LT(albedo, 1) << roughness << " " << polar;
            EXPECT_GT(albedo, 0) << roughness << " " << polar;
        }
    // alpha = 1 seen from straight above: the integral of D G cos over mirrors within 45 degrees is
    // 3 * integral of (1 - 2 s^2) s^2/(1 - s^2) ds up to s = sqrt(1/2). In four dimensions most
    // mirrors of so rough a surface send light below it.
    const double s = std::sqrt(0.5);
    EXPECT_NEAR(albedo_of(Microfacet(1), Vec4::UnitW()),
                3 * (2 * s * s * s / 3 + s - std::atanh(s)), 1e-5);
    // A narrow lobe loses next to nothing.
    EXPECT_NEAR(albedo_of(Microfacet(0.25), direction_at(0.5, 0)), 1, 0.01);
}

TEST(Microfacet, DensityIntegratesToOne) {
    // Over all of S^3: mirrored directions may lie below the surface. Where the half vector sinks
    // below the horizon the density ends with a jump, which midpoints see to a step of 1/1200 (with
    // 4800 steps the sums are within 1e-4).
    for (double roughness : kRoughnesses)
        for (double polar : {0.1, 0.8, 1.4}) {
            const Microfacet facets(roughness);
            const Vec4 out = direction_at(polar, 0);
            EXPECT_NEAR(integral([&](const Vec4& in) { return facets.density(out, in); }, 0, pi, 0,
                                 pi, 1200),
                        1, 1.5e-3)
                << roughness << " " << polar;
        }
}

TEST(Microfacet, SamplesFollowTheirDensity) {
    // Chi-squared over 16 x 8 cells of polar angle and turn; cells that expect fewer than
    // 20 of 40000 samples are put together.
    Random random(512);
    for (double roughness : kRoughnesses)
        for (double polar : {0.0, 0.9, 1.4}) {
            const Microfacet facets(roughness);
            const Vec4 out = direction_at(polar, 0);
            constexpr int kCount = 40'000, kRows = 16, kColumns = 8;
            std::vector<double> count(kRows * kColumns);
            double back = 0, back_square = 0;
            for (int i = 0; i < kCount; ++i) {
                const Vec4 in = facets.sample(
                    out, {uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)});
                ASSERT_NEAR(in.norm(), 1, 1e-14);
                const double across = in.head<3>().norm();
                const int row =
                    std::min(kRows - 1, static_cast<int>(kRows * std::atan2(across, in[3]) / pi));
                const int column = std::clamp(
                    static_cast<int>(kColumns * std::acos(std::clamp(in[0] / across, -1.0, 1.0)) /
                                     pi),
                    0, kColumns - 1);
                ++count[static_cast<std::size_t>(kColumns * row + column)];
                const double weight =
                    in[3] > 0 ? facets.brdf(out, in) * in[3] / facets.density(out, in) : 0;
                ASSERT_LE(weight, 1 + 1e-12);
                back += weight, back_square += weight * weight;
            }
            double chi = 0, rest = 0, rest_expected = 0;
            int cells = 0;
            for (int row = 0; row < kRows; ++row)
                for (int column = 0; column < kColumns; ++column) {
                    const double expected =
                        kCount * integral([&](const Vec4& in) { return facets.density(out, in); },
                                          pi * row / kRows, pi * (row + 1) / kRows,
                                          pi * column / kColumns, pi * (column + 1) / kColumns, 60);
                    const double c = count[static_cast<std::size_t>(kColumns * row + column)];
                    if (expected < 20) {
                        rest += c, rest_expected += expected;
                        continue;
                    }
                    chi += (c - expected) * (c - expected) / expected;
                    ++cells;
                }
            if (rest_expected > 20) {
                chi += (rest - rest_expected) * (rest - rest_expected) / rest_expected;
                ++cells;
            }
            EXPECT_GT(cells, 10);
            EXPECT_NEAR(chi, cells - 1, 5 * std::sqrt(2.0 * (cells - 1)))
                << roughness << " " << polar;
            // Their mean weight is the directional albedo.
            const double mean = back / kCount;
            const double sigma = std::sqrt((back_square / kCount - mean * mean) / kCount);
            EXPECT_NEAR(mean, albedo_of(facets, out), 5 * sigma + 1e-4);
        }
}

}  // namespace
}  // namespace tesserae::render
