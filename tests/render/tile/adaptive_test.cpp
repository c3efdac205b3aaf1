// SPDX-License-Identifier: Apache-2.0
#include "render/tile/adaptive.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace tesserae::render {
namespace {

using AdaptiveRandom = std::mt19937_64;

double unit(AdaptiveRandom& random) { return std::ldexp(static_cast<double>(random()), -64); }

/// What a pixel's samples are drawn from.
struct Light {
    std::string name;
    double mean;
    std::function<double(AdaptiveRandom&)> draw;
    int pixels = 60'000;  ///< enough of them for their mean to be known to 0.1 %
};

/// Grey light of value `bright` that a part `chance` of the samples meets.
Light rare(double chance, double bright) {
    return {std::to_string(chance), chance * bright,
            [=](AdaptiveRandom& random) { return unit(random) < chance ? bright : 0.0; },
            static_cast<int>(40'000 / chance)};
}

std::vector<Light> some_lights() {
    return {rare(0.12, 8),
            rare(0.5, 0.02),
            // Of tail 1/x^4, and one without a tail, that noise hardly changes.
            {"tail", 1.5, [](AdaptiveRandom& r) { return std::pow(1 - unit(r), -1.0 / 3); }},
            {"even", 0.5, [](AdaptiveRandom& r) { return unit(r); }}};
}

constexpr int kLeast = 16, kMost = 64;
constexpr double kTarget = 0.03;

/// A pixel's halves.
struct Halves {
    std::array<PixelEstimate, 2> part;

    Halves(const Light& light, AdaptiveRandom& random) {
        sample_adaptively(kLeast, kMost, kTarget, [&](std::size_t half, int count) {
            while (part[half].count() < count) part[half].add(Color::Constant(light.draw(random)));
            return part[half];
        });
    }
    double mean() const { return 0.5 * (part[0].mean()[1] + part[1].mean()[1]); }
    int count() const { return part[0].count() + part[1].count(); }
};

/// As the rule is not to be: the samples that decide are averaged.
double mean_that_stops_itself(const Light& light, AdaptiveRandom& random) {
    PixelEstimate all;
    while (all.count() < kLeast || (all.count() < kMost && all.samples_for(kTarget) > all.count()))
        all.add(Color::Constant(light.draw(random)));
    return all.mean()[1];
}

/// Of pixels, in parts of the exact mean.
struct Deviation {
    double mean, sigma;
};
template <class Pixel>
Deviation deviation(const Light& light, int pixels, const Pixel& pixel) {
    AdaptiveRandom random(7);
    double sum = 0, squares = 0;
    for (int i = 0; i < pixels; ++i) {
        const double off = pixel(random) / light.mean - 1;
        sum += off, squares += off * off;
    }
    return {sum / pixels, std::sqrt(squares) / pixels};
}

TEST(Adaptive, TheMeanIsThatOfAnyFixedNumberOfSamples) {
    for (const Light& light : some_lights()) {
        SCOPED_TRACE(light.name);
        const Deviation found = deviation(light, light.pixels, [&](AdaptiveRandom& random) {
            return Halves(light, random).mean();
        });
        EXPECT_LT(4 * found.sigma, 0.005);
        EXPECT_NEAR(found.mean, 0, 4 * found.sigma);
    }
    // The same test sees what a rule does that looks at what it averages.
    const Light light = rare(0.05, 20);
    const Deviation wrong = deviation(light, 20'000, [&](AdaptiveRandom& random) {
        return mean_that_stops_itself(light, random);
    });
    EXPECT_LT(wrong.mean, -0.05);
    EXPECT_LT(wrong.mean, -10 * wrong.sigma);
}

TEST(Adaptive, AHalfsNumberDependsOnTheOtherHalfAlone) {
    AdaptiveRandom random(3);
    for (const std::size_t noisy : {0u, 1u}) {
        std::array<PixelEstimate, 2> part;
        sample_adaptively(17, 65, 0.01, [&](std::size_t half, int count) {
            while (part[half].count() < count)
                part[half].add(Color::Constant(half == noisy ? unit(random) : 0.5));
            return part[half];
        });
        EXPECT_EQ(part[noisy].count(), noisy == 0 ? 9 : 8);
        EXPECT_EQ(part[1 - noisy].count(), noisy == 0 ? 32 : 33);
    }
}

TEST(Adaptive, NumbersLieBetweenTheLeastAndTheMost) {
    AdaptiveRandom random(4);
    for (const Light& light : some_lights())
        for (int i = 0; i < 1000; ++i) {
            const int count = Halves(light, random).count();
            ASSERT_GE(count, kLeast) << light.name;
            ASSERT_LE(count, kMost) << light.name;
        }
}

TEST(Adaptive, TheErrorIsTheTargetWhereThePilotKnowsTheNoise) {
    // Uniform in [0, 1]: deviation sqrt(1/12), 23 samples for an error of 0.03 about 0.5; half of
    // it as the square root shows it.
    const Light even = some_lights().back();
    const double error = 2 * kTarget * std::sqrt(0.5);
    EXPECT_NEAR(1.0 / 12 / (error * error), 46.3, 0.1);
    AdaptiveRandom random(5);
    double squares = 0, samples = 0;
    constexpr int kPixels = 20'000;
    for (int i = 0; i < kPixels; ++i) {
        const Halves pixel(even, random);
        squares += std::pow(std::sqrt(pixel.mean()) - std::sqrt(0.5), 2);
        samples += pixel.count();
    }
    // Eight samples know the deviation to a fifth, the mean to a fifth.
    EXPECT_NEAR(std::sqrt(squares / kPixels) / kTarget, 1, 0.1);
    EXPECT_NEAR(samples / kPixels, 46.3, 5);
}

}  // namespace
}  // namespace tesserae::render
