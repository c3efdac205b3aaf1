// SPDX-License-Identifier: Apache-2.0
#include "render/light/lamps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/render/traced_scene.hpp"

namespace tesserae::render {
namespace {

/// Sphere lights and glowing bodies of all shapes, some of no power to speak of, two in one place.
TestScene many_lamps(Random& random, int count) {
    TestScene scene = path_scene(1);
    scene.materials.resize(3);
    scene.materials[1].emission = {1, 2, 3};
    scene.materials[2].emission = {1e-6, 0, 0};
    for (int i = 0; i < count; ++i) {
        const Vec4 place = i == 1 ? Vec4::Zero() : random_vector(random, 5);
        if (i % 4 == 3)
            scene.lights.spheres.push_back({place, 0.3, Color(3, 1, 1)});
        else
            scene.add(random_shape(random, i % kShapeKinds, 0.5), place, random_rotor(random),
                      i % 5 == 0 ? 2u : 1u);
    }
    scene.add(Hyperplane{Vec4::UnitY(), -9}, Vec4::Zero(), {}, 1);
    return scene;
}

TEST(Lamps, AreTheSphereLightsAndTheBoundedBodiesThatGlow) {
    Random random(541);
    const TracedScene traced(many_lamps(random, 40));
    const Lamps lamps(traced.lights, traced.picture, traced.placed);
    std::size_t bodies = 0;
    for (std::uint32_t i = 0; i < traced.placed.bodies.size(); ++i) {
        const std::uint32_t lamp = lamps.of_body(i);
        if (i + 1 == traced.placed.bodies.size()) {
            EXPECT_EQ(lamp, Lamps::kNone) << "the plane";
            continue;
        }
        ASSERT_NE(lamp, Lamps::kNone);
        EXPECT_EQ(lamps[lamp].body, i);
        ++bodies;
    }
    EXPECT_EQ(bodies, 30u);
    EXPECT_EQ(lamps[lamps.of_sphere(3)].sphere, 3u);
    EXPECT_EQ(lamps.asked(), 1u);
}

TEST(Lamps, AreChosenAsOftenAsTold) {
    Random random(542);
    for (const int count : {5, 6, 17, 64}) {
        const TracedScene traced(many_lamps(random, count));
        const Lamps lamps(traced.lights, traced.picture, traced.placed);
        for (int round = 0; round < 20; ++round) {
            const Vec4 point = random_vector(random, round % 2 ? 5 : 50);
            const Vec4 normal = random_direction(random);
            std::vector<double> chance;
            double sum = 0;
            for (int i = 0; i < count; ++i) {
                chance.push_back(lamps.chance_of(static_cast<std::uint32_t>(i), point, normal));
                sum += chance.back();
            }
            ASSERT_LT(sum, 1 + 1e-12);
            // Where a half of the tree has nothing above the horizon it is not gone into; where
            // both have by their balls but none by its lamps, the choice is lost.
            std::vector<int> chosen(chance.size());
            constexpr int kTries = 4000;
            int lost = 0;
            for (int k = 0; k < kTries; ++k) {
                const auto choice = lamps.choose(0, point, normal, (k + 0.5) / kTries);
                if (!choice) {
                    ++lost;
                    continue;
                }
                ASSERT_NEAR(choice->chance / chance[choice->lamp], 1, 1e-9);
                ++chosen[choice->lamp];
            }
            for (std::size_t i = 0; i < chosen.size(); ++i)
                EXPECT_NEAR(chosen[i], kTries * chance[i], 1.01) << count;
            EXPECT_NEAR(lost, kTries * (1 - sum), 1.01 * count);
        }
    }
}

TEST(Lamps, AboveTheHorizonHaveAChance) {
    Random random(543);
    const TracedScene traced(many_lamps(random, 64));
    const Lamps lamps(traced.lights, traced.picture, traced.placed);
    int above = 0;
    for (int round = 0; round < 200; ++round) {
        const Vec4 point = random_vector(random, 5), normal = random_direction(random);
        for (std::uint32_t i = 0; i < 64; ++i) {
            const double height = normal.dot(lamps[i].centre - point);
            const double chance = lamps.chance_of(i, point, normal);
            ASSERT_TRUE(chance > 0 || height <= 0);
            ASSERT_TRUE(chance == 0 || height >= -lamps[i].radius);
            above += height > 0;
        }
    }
    EXPECT_GT(above, 3000);
}

TEST(Lamps, FewAreAskedOneByOne) {
    Random random(544);
    const TracedScene traced(many_lamps(random, 4));
    const Lamps lamps(traced.lights, traced.picture, traced.placed);
    ASSERT_EQ(lamps.asked(), 4u);
    for (std::uint32_t k = 0; k < 4; ++k) {
        const auto choice = lamps.choose(k, Vec4::Zero(), Vec4::UnitY(), 0.3);
        ASSERT_TRUE(choice);
        EXPECT_EQ(choice->lamp, k);
        EXPECT_EQ(choice->chance, 1);
        EXPECT_EQ(lamps.chance_of(k, Vec4::Zero(), -Vec4::UnitY()), 1);
    }
}

}  // namespace
}  // namespace tesserae::render
