// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/sampler.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// Of several frames and seeds, each with its second one.
std::vector<std::uint64_t> some_patterns() {
    std::vector<std::uint64_t> patterns;
    for (const std::uint64_t seed : {0ull, 1ull, 0x7fffffffffffffffull})
        for (const int frame : {0, 1, 2, 9'999'999}) {
            patterns.push_back(sample_pattern(seed, frame));
            patterns.push_back(second_pattern(patterns.back()));
        }
    return patterns;
}

TEST(SamplePattern, IsTodaysForFrameZeroAndNoOtherFramesOrSeeds) {
    EXPECT_EQ(sample_pattern(0, 0), 0u);
    std::set<std::uint64_t> patterns;
    for (std::uint64_t seed = 0; seed < 100; ++seed)
        for (int frame = 0; frame < 500; ++frame) {
            patterns.insert(sample_pattern(seed, frame));
            patterns.insert(second_pattern(sample_pattern(seed, frame)));
        }
    EXPECT_EQ(patterns.size(), 2u * 100 * 500);
}

TEST(PixelSample, EveryElementaryCellHoldsOnePoint) {
    const auto patterns = some_patterns();
    // The property that makes a (0, m, 2)-net, which Owen scrambling keeps.
    for (int pixel = 0; pixel < 50; ++pixel)
        for (int m = 0; m <= 8; ++m)
            for (int k = 0; k <= m; ++k) {
                const int columns = 1 << k, rows = 1 << (m - k);
                std::vector<int> count(static_cast<std::size_t>(columns * rows));
                for (std::uint32_t i = 0; i < (1u << m); ++i) {
                    const Vec2 p =
                        pixel_sample(37 * pixel, 11 * pixel, i,
                                     patterns[static_cast<std::size_t>(pixel) % patterns.size()]);
                    ASSERT_TRUE(p.x() >= 0 && p.x() < 1 && p.y() >= 0 && p.y() < 1);
                    const int cell = static_cast<int>(p.x() * columns) +
                                     columns * static_cast<int>(p.y() * rows);
                    ++count[static_cast<std::size_t>(cell)];
                }
                for (int c : count) ASSERT_EQ(c, 1) << "pixel " << pixel << " " << k << "/" << m;
            }
}

TEST(PixelSample, FirstSamplesOfPixelsAreUniform) {
    // Chi-squared over 16 x 16 cells of the first sample of 128 x 128 pixels: 255 degrees of
    // freedom, mean 255, deviation sqrt(510) = 22.6.
    std::vector<double> count(256);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const Vec2 p = pixel_sample(x, y, 0);
            ++count[static_cast<std::size_t>(16 * p.x()) +
                    16 * static_cast<std::size_t>(16 * p.y())];
        }
    double chi = 0;
    for (double c : count) chi += (c - 64) * (c - 64) / 64;
    EXPECT_NEAR(chi, 255, 5 * 22.6);
}

TEST(PixelSample, PixelsHaveDifferentPatterns) {
    std::set<double> seen;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) seen.insert(pixel_sample(x, y, 3).x());
    // Of 2^32 values 4096 draws repeat one with probability 2 in 1000; a repeated pattern of any
    // period would halve the count at least.
    EXPECT_GT(seen.size(), 4090u);
}

/// How many of the first 2^m points lie in each cell of a grid of 2^k[d] along dimension d.
std::vector<int> counts(int x, int y, std::uint32_t group, int m, const std::array<int, 4>& k) {
    std::vector<int> count(std::size_t{1} << (k[0] + k[1] + k[2] + k[3]));
    const auto patterns = some_patterns();
    const Sampler sampler(x, y, 0, patterns[static_cast<std::size_t>(x) % patterns.size()]);
    for (std::uint32_t i = 0; i < (1u << m); ++i) {
        const auto p = sampler.of(i).group(group);
        std::size_t cell = 0;
        for (std::size_t d = 0; d < 4; ++d) {
            EXPECT_TRUE(p[d] >= 0 && p[d] < 1);
            cell = (cell << k[d]) + static_cast<std::size_t>(p[d] * (1 << k[d]));
        }
        ++count[cell];
    }
    return count;
}

TEST(Sampler, EveryElementaryIntervalHoldsItsShare) {
    // Sobol's first d dimensions are a (t, m, d)-net with t the sum of their polynomials' degrees
    // less one: 0 for the first two, 1 for three, 3 for four. In every box of volume 2^(t - m) with
    // sides 1/2^k lie 2^t points; of each dimension alone one in each of 2^m intervals.
    const auto expect_share = [](std::uint32_t group, int m, const std::array<int, 4>& k, int t) {
        for (int c : counts(3 + 5 * static_cast<int>(group), 7, group, m, k))
            ASSERT_EQ(c, 1 << t) << "group " << group << " m " << m << " k " << k[0] << k[1] << k[2]
                                 << k[3];
    };
    for (std::uint32_t group : {0u, 1u, 2u, 17u, 1000003u})
        for (int m = 0; m <= 8; ++m) {
            for (std::size_t d = 0; d < 4; ++d) {
                std::array<int, 4> k = {};
                k[d] = m;
                expect_share(group, m, k, 0);
            }
            for (int k0 = 0; k0 <= m; ++k0) expect_share(group, m, {k0, m - k0, 0, 0}, 0);
            for (int k0 = 0; k0 < m; ++k0)
                for (int k1 = 0; k1 < m - k0; ++k1)
                    expect_share(group, m, {k0, k1, m - 1 - k0 - k1, 0}, 1);
            for (int k0 = 0; k0 <= m - 3; ++k0)
                for (int k1 = 0; k1 <= m - 3 - k0; ++k1)
                    for (int k2 = 0; k2 <= m - 3 - k0 - k1; ++k2)
                        expect_share(group, m, {k0, k1, k2, m - 3 - k0 - k1 - k2}, 3);
        }
}

TEST(Sampler, FourSamplesAtOnceAreThoseOfEach) {
    Random random(311);
    for (int i = 0; i < 1000; ++i) {
        const auto number = [&] { return static_cast<int>(uniform(random, 0, 2e9)); };
        std::vector<Sampler> samplers;
        for (int k = 0; k < 4; ++k)  // some of one pixel
            samplers.emplace_back(i % 3 ? i : number(), 7 + k / (1 + i % 4),
                                  static_cast<std::uint32_t>(i < 500 ? i + k : number()));
        const auto group = static_cast<std::uint32_t>(i % 40);
        const auto four =
            Sampler::groups({&samplers[0], &samplers[1], &samplers[2], &samplers[3]}, group);
        for (std::size_t k = 0; k < 4; ++k) {
            const auto one = samplers[k].group(group);
            for (std::size_t n = 0; n < 4; ++n) ASSERT_EQ(four[n][k], one[n]) << i;
        }
    }
}

TEST(Sampler, LaterBlocksOfSamplesAreNetsToo) {
    // Samples 64 to 127, 128 to 191, ...: the shuffle keeps aligned blocks together.
    for (std::uint32_t block = 1; block < 5; ++block) {
        std::vector<int> count(64);
        for (std::uint32_t i = 0; i < 64; ++i) {
            const auto p = Sampler(5, 6, 64 * block + i).group(3);
            ++count[static_cast<std::size_t>(8 * p[0]) + 8 * static_cast<std::size_t>(8 * p[1])];
        }
        for (int c : count) EXPECT_EQ(c, 1);
    }
}

/// Chi-squared over 16 x 16 cells of 16384 pairs of numbers: of independent ones with 255 degrees
/// of freedom, deviation 22.6.
template <class F>
double chi_of(const F& pair) {
    std::vector<double> count(256);
    for (int i = 0; i < 16384; ++i) {
        const auto [a, b] = pair(i);
        ++count[static_cast<std::size_t>(16 * a) + 16 * static_cast<std::size_t>(16 * b)];
    }
    double chi = 0;
    for (double c : count) chi += (c - 64) * (c - 64) / 64;
    return chi;
}

void expect_independent_patterns(std::size_t every) {
    // The same sample of the same pixel, and of its neighbour, in two patterns.
    const auto expect_independent = [](std::uint64_t a, std::uint64_t b) {
        for (const int moved : {0, 1}) {
            const auto pair = [&](auto&& number) {
                return [&, number](int i) {
                    return std::pair<double, double>(number(i % 128, i / 128, a),
                                                     number(i % 128 + moved, i / 128, b));
                };
            };
            EXPECT_NEAR(chi_of(pair([](int x, int y, std::uint64_t p) {
                            return pixel_sample(x, y, 3, p).x();
                        })),
                        255, 5 * 22.6)
                << a << " " << b;
            EXPECT_NEAR(chi_of(pair([](int x, int y, std::uint64_t p) {
                            return Sampler(x, y, 3, p).group(0)[1];
                        })),
                        255, 5 * 22.6)
                << a << " " << b;
        }
    };
    const auto patterns = some_patterns();
    for (std::size_t i = 0; i < patterns.size(); ++i)
        for (std::size_t j = 0; j < i; j += every) expect_independent(patterns[i], patterns[j]);
}

TEST(SamplePattern, PatternsAreIndependent) { expect_independent_patterns(5); }
TEST(SamplePatternSlow, PatternsAreIndependent) { expect_independent_patterns(1); }

TEST(Sampler, GroupsPixelsAndSamplesAreIndependent) {
    using Pair = std::pair<double, double>;
    const auto at = [](int x, int y, std::uint32_t i, std::uint32_t g, std::size_t d) {
        return Sampler(x, y, i).group(g)[d];
    };
    const auto column = [](int i) { return i % 128; };
    const auto row = [](int i) { return i / 128; };
    // Two pixels side by side; two groups; the film's point and the first group. Over pixels, since
    // over one pixel's samples each of the two is stratified and the sum would be too even.
    EXPECT_NEAR(chi_of([&](int i) {
                    return Pair(at(2 * column(i), row(i), 5, 1, 2),
                                at(2 * column(i) + 1, row(i), 5, 1, 2));
                }),
                255, 5 * 22.6);
    EXPECT_NEAR(chi_of([&](int i) {
                    return Pair(at(column(i), row(i), 9, 1, 0), at(column(i), row(i), 9, 2, 0));
                }),
                255, 5 * 22.6);
    EXPECT_NEAR(chi_of([&](int i) {
                    return Pair(pixel_sample(column(i), row(i), 0).x(),
                                at(column(i), row(i), 0, 0, 0));
                }),
                255, 5 * 22.6);
    // Within one pixel, groups are shuffled against each other: not the same strata in pairs, which
    // would fill 16 of the 256 cells and give 15 * 16384.
    EXPECT_LT(chi_of([&](int i) {
                  const auto s = static_cast<std::uint32_t>(i);
                  return Pair(at(1, 2, s, 1, 0), at(1, 2, s, 2, 0));
              }),
              255 + 5 * 22.6);
}

/// Root mean square error over pixels of the mean of n samples of f on a group.
template <class F>
double error_of_mean(int n, double exact, const F& f) {
    double square = 0;
    constexpr int kPixels = 400;
    for (int pixel = 0; pixel < kPixels; ++pixel) {
        double sum = 0;
        for (int i = 0; i < n; ++i)
            sum += f(Sampler(pixel, 1, static_cast<std::uint32_t>(i)).group(2));
        square += (sum / n - exact) * (sum / n - exact);
    }
    return std::sqrt(square / kPixels);
}

TEST(Sampler, SmoothIntegrandsConvergeFasterThanRandom) {
    // A product over four dimensions of 1 + (u - 1/2), exact 1: independent random numbers give
    // sqrt(((1 + 1/12)^4 - 1)/n), slope -1/2. An Owen-scrambled net's slope on smooth functions
    // tends to -3/2; -1 over this range tells it from random by far.
    const auto smooth = [](const std::array<double, 4>& u) {
        return (0.5 + u[0]) * (0.5 + u[1]) * (0.5 + u[2]) * (0.5 + u[3]);
    };
    const double few = error_of_mean(16, 1, smooth), many = error_of_mean(1024, 1, smooth);
    EXPECT_LT(std::log(many / few) / std::log(64), -1.0) << few << " " << many;
    EXPECT_LT(few, 0.6 * std::sqrt((std::pow(13.0 / 12, 4) - 1) / 16));
    // A step across all four dimensions, exact 1/2 by symmetry: slope -(1/2 + 1/8) at best.
    const auto step = [](const std::array<double, 4>& u) {
        return u[0] + u[1] + u[2] + u[3] > 2 ? 1.0 : 0.0;
    };
    const double few_step = error_of_mean(16, 0.5, step);
    const double many_step = error_of_mean(1024, 0.5, step);
    EXPECT_LT(std::log(many_step / few_step) / std::log(64), -0.53) << few_step << " " << many_step;
}

}  // namespace
}  // namespace tesserae::render
