// SPDX-License-Identifier: Apache-2.0
// Bodies that start inside each other are told, against every two of them tried.
#include "scenes/plan/overlaps.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

std::vector<std::string> warnings_of(const std::string& text) {
    return overlap_warnings(load_text(text));
}

std::string ball_at(double x, const char* more = "") {
    return fmt::format(
        "[[body]]\nshape = \"hypersphere\"\nradius = 0.5\nposition = [{}, 0, 0, 0]\n{}", x, more);
}

TEST(Overlaps, AreToldWithNamesAndDepth) {
    const auto told =
        warnings_of("[physics]\n" + ball_at(0, "name = \"a\"\n") + ball_at(0.75, "name = \"b\"\n"));
    ASSERT_EQ(told.size(), 1U);
    EXPECT_EQ(told[0],
              "\"a\" and \"b\" start inside each other by 0.25 m: they will be pushed apart");
}

TEST(Overlaps, AreNotToldOfWhatTouchesOrStandsStill) {
    EXPECT_TRUE(warnings_of("[physics]\n" + ball_at(0) + ball_at(1)).empty());
    EXPECT_TRUE(warnings_of("[physics]\n" + ball_at(0) + ball_at(0.9999)).empty());
    EXPECT_TRUE(warnings_of(ball_at(0) + ball_at(0.5)).empty()) << "a still";
    const char* const fixed = "fixed = [\"position\", \"rotation\"]\n";
    EXPECT_TRUE(warnings_of("[physics]\n" + ball_at(0, fixed) + ball_at(0.5, fixed)).empty());
    EXPECT_EQ(warnings_of("[physics]\n" + ball_at(0, fixed) + ball_at(0.5)).size(), 1U);
    const char* const held = "fixed = [\"position\"]\n";
    EXPECT_TRUE(warnings_of("[physics]\n" + ball_at(0, held) + ball_at(0.5, held)).empty());
    EXPECT_TRUE(warnings_of("[physics]\nduration = 0\n" + ball_at(0) + ball_at(0.5)).empty());
    EXPECT_EQ(warnings_of("[physics]\n" + ball_at(0) +
                          "[[body]]\nname = \"floor\"\nshape = \"hyperplane\"\n"
                          "normal = [0, 1, 0, 0]\noffset = -0.2\n")
                  .size(),
              1U);
}

TEST(Overlaps, AreNotToldOfWhatAJointKeepsApart) {
    const auto told_with = [](const std::string& keys) {
        return warnings_of("[physics]\n" + ball_at(0) + ball_at(0.5) +
                           "[[joint]]\ntype = \"weld\"\na = \"body-1\"\nb = \"body-0\"\n"
                           "anchor = [0, 0, 0, 0]\n" +
                           keys)
            .size();
    };
    EXPECT_EQ(told_with(""), 0U);
    EXPECT_EQ(told_with("collide = true\n"), 1U);
}

TEST(Overlaps, OfRandomBallsAreAllThatThereAre) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> place(-1.5, 1.5), radius(0.2, 0.5);
    for (int trial = 0; trial < 50; ++trial) {
        std::string text = "[physics]\n";
        std::vector<std::pair<Vec4, double>> balls;
        for (int i = 0; i < 12; ++i) {
            const Vec4 p(place(random), place(random), place(random), place(random));
            balls.emplace_back(p, radius(random));
            text += fmt::format(
                "[[body]]\nshape = \"hypersphere\"\nradius = {:.17g}\n"
                "position = [{:.17g}, {:.17g}, {:.17g}, {:.17g}]\n",
                balls.back().second, p[0], p[1], p[2], p[3]);
        }
        std::vector<double> depths;
        for (std::size_t a = 0; a < balls.size(); ++a)
            for (std::size_t b = a + 1; b < balls.size(); ++b) {
                const double depth =
                    balls[a].second + balls[b].second - (balls[a].first - balls[b].first).norm();
                // Twice what the solver allows: see overlaps.cpp.
                if (depth > 0.01 * std::min(balls[a].second, balls[b].second))
                    depths.push_back(depth);
            }
        std::sort(depths.rbegin(), depths.rend());
        const auto told = warnings_of(text);
        ASSERT_EQ(told.size(), std::min<std::size_t>(depths.size(), 5) + (depths.size() > 5));
        for (std::size_t i = 0; i < std::min<std::size_t>(depths.size(), 5); ++i)
            EXPECT_NE(told[i].find(fmt::format("by {:.3g} m", depths[i])), std::string::npos)
                << told[i] << " " << depths[i];
        if (depths.size() > 5) {
            EXPECT_TRUE(told.back().starts_with(fmt::format("{} pairs more", depths.size() - 5)));
        }
    }
}

}  // namespace
}  // namespace tesserae::scenes
