// SPDX-License-Identifier: Apache-2.0
#include "render/material/rough.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/render/sphere_quadrature.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

constexpr double kTabulated[] = {0.4, 0.6, 1.0};
constexpr double kPolars[] = {0.0, 0.7, 1.2, 1.5};
const Color kWhite = Color::Ones();
/// Of E: from 33 nodes between which it is a straight line (4e-4), means of 48 x 48 mirrors (2e-4),
/// and of the midpoints here where out is near the horizon (4e-4; 1e-3 at a polar angle of 1.56).
constexpr double kTable = 1e-3;

TEST(RoughReflection, WhiteSurfaceLosesNothing) {
    for (double roughness : kTabulated) {
        const RoughReflection rough(roughness);
        for (double polar : kPolars) {
            const Vec4 out = direction_at(polar, 0);
            EXPECT_NEAR(albedo_by_quadrature(
                            [&](const Vec4& in) { return rough.brdf(kWhite, out, in)[0]; }),
                        1, kTable)
                << roughness << " " << polar;
        }
    }
}

TEST(RoughReflection, KnowsWhatOneReflectionSendsBack) {
    for (double roughness : kTabulated) {
        const RoughReflection rough(roughness);
        const Microfacet facets(roughness);
        for (double polar : kPolars) {
            const Vec4 out = direction_at(polar, 0);
            EXPECT_NEAR(rough.single_part(out[3]),
                        albedo_by_quadrature([&](const Vec4& in) { return facets.brdf(out, in); }),
                        kTable)
                << roughness << " " << polar;
        }
    }
    // In closed form, as in Microfacet.SendsBackNoMoreThanItGets.
    const double s = std::sqrt(0.5);
    EXPECT_NEAR(RoughReflection(1).single_part(1), 3 * (2 * s * s * s / 3 + s - std::atanh(s)),
                kTable);
    for (double roughness : {1e-9, 0.01, 0.1})
        EXPECT_NEAR(RoughReflection(roughness).single_part(0.5), 1, 1e-3) << roughness;
}

TEST(RoughReflection, FurtherReflectionsTint) {
    // Of a uniform field: a E after one reflection; of the rest (1 - E) the k-th further one sends
    // a^(k+1) m (1 - m)^(k-1), where m is the mean of E over the hemisphere's cosine.
    const double roughness = 0.8;
    const RoughReflection rough(roughness);
    double mean = 0;
    constexpr int kSteps = 10'000;
    for (int i = 0; i < kSteps; ++i) {
        const double sine = (i + 0.5) / kSteps;
        mean += 3 * sine * sine * rough.single_part(std::sqrt(1 - sine * sine)) / kSteps;
    }
    const Color albedo(0.9, 0.5, 0.1);
    const Vec4 out = direction_at(0.9, 0);
    for (int c = 0; c < 3; ++c) {
        const double single = rough.single_part(out[3]);
        double expected = albedo[c] * single;
        for (int k = 1; k < 1000; ++k)
            expected +=
                (1 - single) * std::pow(albedo[c], k + 1) * mean * std::pow(1 - mean, k - 1);
        EXPECT_NEAR(
            albedo_by_quadrature([&](const Vec4& in) { return rough.brdf(albedo, out, in)[c]; }),
            expected, kTable)
            << c;
    }
}

TEST(RoughReflection, IsReciprocal) {
    Random random(531);
    const Color albedo(0.2, 0.7, 1);
    for (double roughness : {0.05, 0.3, 0.7, 1.0}) {
        const RoughReflection rough(roughness);
        for (int i = 0; i < 1000; ++i) {
            Vec4 a = random_direction(random), b = random_direction(random);
            a[3] = std::abs(a[3]), b[3] = std::abs(b[3]);
            const Color there = rough.brdf(albedo, a, b), back = rough.brdf(albedo, b, a);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(there[c], back[c], 1e-12 * there[c]);
        }
    }
    EXPECT_EQ(RoughReflection(0.5).brdf(kWhite, Vec4::UnitW(), Vec4(1, 0, 0, 0))[0], 0);
}

TEST(RoughReflection, DensityIntegratesToOneAndItsSamplesWeighLittle) {
    Random random(532);
    for (double roughness : kTabulated) {
        const RoughReflection rough(roughness);
        for (double polar : {0.1, 0.8, 1.4}) {
            const Vec4 out = direction_at(polar, 0);
            // The bound of Microfacet.DensityIntegratesToOne.
            EXPECT_NEAR(integral([&](const Vec4& in) { return rough.density(out, in); }, 0, pi, 0,
                                 pi, 1200),
                        1, 1.5e-3)
                << roughness << " " << polar;
            // The mean of value * cos / density is the albedo, 1: so `sample` follows `density`.
            constexpr int kCount = 40'000;
            double sum = 0, square = 0;
            for (int i = 0; i < kCount; ++i) {
                const Vec4 in = rough.sample(
                    out, {uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)});
                ASSERT_NEAR(in.norm(), 1, 1e-14);
                const double weight =
                    in[3] > 0 ? rough.brdf(kWhite, out, in)[0] * in[3] / rough.density(out, in) : 0;
                // At most 2 E/(1 + E) + 2 (1 - E(in))/(1 - mean).
                ASSERT_LE(weight, 1 + 2 * 1.5);
                sum += weight, square += weight * weight;
            }
            const double mean = sum / kCount;
            EXPECT_NEAR(mean, 1, 5 * std::sqrt((square / kCount - mean * mean) / kCount) + kTable)
                << roughness << " " << polar;
        }
    }
}

TEST(RoughReflections, AreSharedByMaterialsOfOneRoughness) {
    std::vector<Material> materials(5);
    for (int i : {1, 2, 3, 4}) materials[i].kind = MaterialKind::kRough;
    materials[1].roughness = materials[2].roughness = 0.5;
    materials[3].roughness = 0.7;
    materials[4].roughness = 0;  // a mirror
    const RoughReflections rough(materials);
    EXPECT_EQ(rough.of(materials[0]), nullptr);
    EXPECT_EQ(rough.of(materials[4]), nullptr);
    ASSERT_NE(rough.of(materials[1]), nullptr);
    EXPECT_EQ(rough.of(materials[1]), rough.of(materials[2]));
    EXPECT_NE(rough.of(materials[1]), rough.of(materials[3]));
}

}  // namespace
}  // namespace tesserae::render
