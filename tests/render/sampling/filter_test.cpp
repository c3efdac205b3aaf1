// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/tile/pixel_estimate.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// The places of evenly spaced u along x, relative to the centre.
std::vector<double> places(const PixelFilter& filter, int count) {
    std::vector<double> list;
    for (int i = 0; i < count; ++i)
        list.push_back(filter.place({(i + 0.5) / count, 0.5}).x() - 0.5);
    return list;
}

/// The share of a filter left of x, by Simpson's rule over its formula: x and the filter's
/// argument in parts of the width.
double share_below(double x, double (*density)(double)) {
    const auto integral = [&](double end) {
        constexpr int kSteps = 20000;
        const double h = (end + 0.5) / kSteps;
        double sum = density(-0.5) + density(end);
        for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4 : 2) * density(-0.5 + i * h);
        return sum * h / 3;
    };
    return integral(x) / integral(0.5);
}

struct Case {
    FilterKind kind;
    double (*density)(double);
};
const Case kCases[] = {{FilterKind::kBox, [](double) { return 1.0; }},
                       {FilterKind::kTriangle, [](double x) { return 1 - 2 * std::abs(x); }},
                       {FilterKind::kGaussian, [](double x) { return std::exp(-18 * x * x); }},
                       {FilterKind::kBlackmanHarris, [](double x) {
                            const double t = 2 * std::numbers::pi * (x + 0.5);
                            return 0.35875 - 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) -
                                   0.01168 * std::cos(3 * t);
                        }}};

TEST(PixelFilter, SamplesFallWithItsDensity) {
    for (const Case& c : kCases)
        for (const double width : {1.0, 1.5, 4.0}) {
            const PixelFilter filter(c.kind, width);
            constexpr int kCount = 1000;
            const auto list = places(filter, kCount);
            for (int i = 0; i < kCount; i += 37) {
                const double x = list[static_cast<std::size_t>(i)] / width;
                // The sample of u lies where the share left of it is u; interpolation inside one of
                // 1024 shares is off by less than half of it, and that only in the tails.
                EXPECT_NEAR(share_below(x, c.density), (i + 0.5) / kCount, 0.5 / 1024)
                    << static_cast<int>(c.kind) << " " << width;
            }
        }
}

TEST(PixelFilter, StaysWithinItsWidthAndIsSymmetric) {
    for (const Case& c : kCases) {
        const PixelFilter filter(c.kind, 3);
        const double last = 1 - 0x1p-32;
        for (const double u : {0.0, 1e-9, 0.3, 0.5, 0.9, last}) {
            const Vec2 place = filter.place({u, last - u});
            EXPECT_LE(std::abs(place.x() - 0.5), 1.5);
            EXPECT_NEAR(place.x() - 0.5, -(place.y() - 0.5), 1e-4);
        }
        EXPECT_NEAR(filter.place({0.5, 0.5}).x(), 0.5, 1e-12);
    }
}

TEST(PixelFilter, ABoxOfOnePixelIsThePixel) {
    const PixelFilter filter(FilterKind::kBox, 1);
    EXPECT_EQ(filter.place({0.25, 0.75}), Vec2(0.25, 0.75));
}

TEST(PixelEstimate, IsMeanAndVarianceOfTheMean) {
    Random random(5);
    PixelEstimate estimate;
    Color sum = Color::Zero(), squares = Color::Zero();
    constexpr int kCount = 500;
    for (int i = 0; i < kCount; ++i) {
        const Color c(uniform(random, 0, 1), 1000 + uniform(random, 0, 1e-3), i % 2);
        estimate.add(c);
        sum += c;
        const Color about(0.5, 1000, 0.5);
        squares += (c - about) * (c - about);
    }
    const Color mean = sum / kCount;
    EXPECT_LT((estimate.mean() - mean).abs().maxCoeff(), 1e-10);
    const Color off = mean - Color(0.5, 1000, 0.5);
    const Color variance = (squares / kCount - off * off) / (kCount - 1);
    EXPECT_LT((estimate.variance() / variance - 1).abs().maxCoeff(), 1e-6);
}

TEST(PixelEstimate, SaysHowManySamplesBringTheNoiseDown) {
    PixelEstimate estimate;
    EXPECT_EQ(estimate.samples_for(0.1), std::numeric_limits<double>::infinity());
    for (int i = 0; i < 100; ++i) estimate.add(Color::Constant(i % 2 == 0 ? 0.3 : 0.2));
    // Standard deviation 0.05 of one sample (times sqrt(100/99)); what is the error of a mean 0.25
    // that shows as 0.001 in a picture encoded by its square root?
    const double error = std::pow(0.5 + 0.001 / 2, 2) - std::pow(0.5 - 0.001 / 2, 2);
    EXPECT_NEAR(estimate.samples_for(0.001), 0.05 * 0.05 * 100 / 99 / (error * error), 1e-9);
    // Darker than its error: encoded as if it were that bright.
    PixelEstimate dark;
    for (const double bright : {0.0, 0.0, 0.0, 4e-6}) dark.add(Color::Constant(bright));
    const double count = dark.samples_for(0.01), left = 2e-6 / std::sqrt(count);
    EXPECT_NEAR(left / (2 * std::sqrt(left)), 0.01, 1e-9);
}

TEST(PixelEstimate, WithoutVariationNeedsNoMoreSamples) {
    PixelEstimate estimate;
    for (int i = 0; i < 2; ++i) estimate.add(Color::Zero());
    EXPECT_EQ(estimate.samples_for(0.01), 0);
    EXPECT_EQ(estimate.samples_for(1e-300), 0);
}

}  // namespace
}  // namespace tesserae::render
