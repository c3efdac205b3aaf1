#include "render/sampler.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace tesserae::render {
namespace {

TEST(PixelSample, EveryElementaryCellHoldsOnePoint) {
    // The property that makes a (0, m, 2)-net, which Owen scrambling keeps.
    for (int pixel = 0; pixel < 50; ++pixel)
        for (int m = 0; m <= 8; ++m)
            for (int k = 0; k <= m; ++k) {
                const int columns = 1 << k, rows = 1 << (m - k);
                std::vector<int> count(static_cast<std::size_t>(columns * rows));
                for (std::uint32_t i = 0; i < (1u << m); ++i) {
                    const Vec2 p = pixel_sample(37 * pixel, 11 * pixel, i);
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

}  // namespace
}  // namespace tesserae::render
