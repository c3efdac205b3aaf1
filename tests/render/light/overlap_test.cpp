// SPDX-License-Identifier: Apache-2.0
#include "render/light/overlap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

using Vec3 = Eigen::Vector3d;

/// Of clear_part, as its header says: in parts of the disc.
constexpr double kAccuracy = 0.06;

Vec3 ball_point(Random& random) {
    for (;;) {
        const Vec3 p(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
        if (p.squaredNorm() <= 1) return p;
    }
}

DiscCover random_cover(Random& random, std::uint32_t body, double most, double least_bend) {
    const double bend = uniform(random, least_bend, 3);
    return {body, uniform(random, -0.95, most), ball_point(random).normalized(), 1 / bend};
}

/// By points of the disc; five deviations are 0.025 of it.
double clear_by_points(Random& random, const std::vector<DiscCover>& covers) {
    constexpr int kPoints = 10'000;
    int clear = 0;
    for (int i = 0; i < kPoints; ++i) {
        const Vec3 p = ball_point(random);
        clear += std::none_of(covers.begin(), covers.end(), [&](const DiscCover& c) {
            return (p - (c.rim + c.radius) * c.toward).norm() < c.radius;
        });
    }
    return static_cast<double>(clear) / kPoints;
}

TEST(Overlap, OfBallsMatchesPoints) {
    Random random(610);
    double square = 0;
    constexpr int kRounds = 80;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<DiscCover> covers;
        for (std::uint32_t i = 0; i < 2u + static_cast<std::uint32_t>(round) % 4; ++i)
            covers.push_back(random_cover(random, i, 0.5, 0.01));
        const double error = clear_part(covers) - clear_by_points(random, covers);
        EXPECT_LT(std::abs(error), kAccuracy + 0.025) << round;
        square += error * error / kRounds;
    }
    // Of which the points' own deviation is 0.005.
    EXPECT_LT(std::sqrt(square), 0.018);
}

TEST(Overlap, OfFlatRimsMatchesPointsWhereverTheyLie) {
    Random random(611);
    for (int round = 0; round < 40; ++round) {
        std::vector<DiscCover> covers;
        for (std::uint32_t i = 0; i < 2; ++i) {
            covers.push_back(random_cover(random, i, 0.99, 0));
            covers.back().radius = i == 0 ? 1e3 : 1e7;
        }
        EXPECT_NEAR(clear_part(covers), clear_by_points(random, covers), kAccuracy + 0.025)
            << round;
    }
}

TEST(Overlap, OrderChangesNoBit) {
    Random random(612);
    for (int round = 0; round < 300; ++round) {
        std::vector<DiscCover> covers;
        const std::uint32_t count = 2 + static_cast<std::uint32_t>(random() % 6);
        for (std::uint32_t i = 0; i < count; ++i)
            covers.push_back(random_cover(random, i, 1, 0.001));
        // Some have the same rim.
        if (round % 3 == 0) covers[1].rim = covers[0].rim;
        const double clear = clear_part(covers);
        for (int k = 0; k < 5; ++k) {
            std::shuffle(covers.begin(), covers.end(), random);
            EXPECT_EQ(clear_part(covers), clear) << round;
        }
    }
}

TEST(Overlap, BeginsWithoutAnEdge) {
    // A second cover that hides nothing yet leaves what the first one's flat rim leaves, bent as it
    // may be; one more that holds what is held already changes nothing.
    Random random(613);
    for (int round = 0; round < 200; ++round) {
        std::vector<DiscCover> covers = {random_cover(random, 0, 0.9, 0.01),
                                         random_cover(random, 1, 0.9, 0.01)};
        covers[1].rim = 1 - 1e-9;
        EXPECT_NEAR(clear_part(covers), visible_part(covers[0].rim), 1e-6) << round;
    }
    std::vector<DiscCover> twice = {random_cover(random, 0, 0.4, 0.01)};
    twice.push_back(twice[0]);
    twice.push_back(twice[0]);
    EXPECT_EQ(clear_part(twice), clear_part(std::span(twice).first(2)));
}

}  // namespace
}  // namespace tesserae::render
