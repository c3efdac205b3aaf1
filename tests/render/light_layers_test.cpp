// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

constexpr const char* kColors[] = {"R", "G", "B"};

/// Bodies of all kinds of shapes that are lit in all ways: by suns, points, spheres, the sky and
/// by what glows.
TestScene lit_scene(bool with_mirrors_and_glass) {
    Random random(5);
    TestScene scene;
    scene.materials.resize(5);
    scene.materials[1].emission = {2, 1, 0.5};
    scene.materials[2].kind = MaterialKind::kRough;
    scene.materials[3].kind = with_mirrors_and_glass ? MaterialKind::kMirror : MaterialKind::kRough;
    scene.materials[4].kind =
        with_mirrors_and_glass ? MaterialKind::kGlass : MaterialKind::kDiffuse;
    for (int i = 0; i < 15; ++i)
        scene.add(random_shape(random, i % kShapeKinds, 1.2), random_vector(random, 1.5),
                  random_rotor(random), static_cast<std::uint32_t>(i % 5));
    scene.add(Hyperplane{Vec4::UnitY(), -1.5}, Vec4::Zero());
    Sun sun;
    sun.direction = Vec4(0.3, -1, 0.4, 0.1).normalized();
    scene.lights.suns.push_back(sun);
    scene.lights.points.push_back({{0, 3, -1, 0}, Color::Constant(20)});
    scene.lights.spheres.push_back({{1, 1.5, -1, 0.1}, 0.3, Color::Constant(3)});
    scene.lights.sky = {0.2, 0.25, 0.3};
    scene.settings.width = 40, scene.settings.height = 30;
    scene.settings.samples = 4;
    scene.settings.integrator = Integrator::kPath;
    scene.settings.channels.light = true;
    return scene;
}

std::string channel(const char* layer, const char* color) {
    return std::string(layer) + "." + color;
}

TEST(LightLayers, AddUpToTheColorAndLeaveItAsItIs) {
    for (const Integrator integrator : {Integrator::kDirect, Integrator::kPath})
        for (const double noise : {0.0, 0.01}) {
            TestScene scene = lit_scene(true);
            scene.settings.integrator = integrator;
            scene.settings.noise_target = noise;
            scene.settings.clamp_indirect = 2;
            const Image image = picture_of(scene);
            scene.settings.channels.light = false;
            const Image plain = picture_of(scene);
            double indirect = 0;
            for (const char* c : kColors) {
                EXPECT_EQ(image.planes.at(c), plain.planes.at(c));
                for (std::size_t i = 0; i < plain.planes.at(c).size(); ++i) {
                    const float d = image.planes.at(channel("direct", c))[i];
                    const float rest = image.planes.at(channel("indirect", c))[i];
                    ASSERT_GE(d, 0);
                    ASSERT_GE(rest, 0);
                    // Three roundings to half, each of 2^-11.
                    const float sum = plain.planes.at(c)[i];
                    ASSERT_NEAR(d + rest, sum, 0.0011 * sum + 1e-6) << c << i;
                    indirect += rest;
                }
            }
            EXPECT_EQ(indirect > 10, integrator == Integrator::kPath);
        }
}

TEST(LightLayers, DirectIsThePictureWithoutBouncesWhereNothingIsSpecular) {
    TestScene scene = lit_scene(false);
    const Image image = picture_of(scene);
    scene.settings.bounces = 0;
    const Image straight = picture_of(scene);
    for (const char* c : kColors) {
        EXPECT_EQ(image.planes.at(channel("direct", c)), straight.planes.at(c));
        EXPECT_EQ(image.planes.at(channel("direct", c)), straight.planes.at(channel("direct", c)));
        for (const float v : straight.planes.at(channel("indirect", c))) ASSERT_EQ(v, 0);
    }
}

TEST(LightLayers, ThroughMirrorsAndGlassDirectIsWhatTheFirstOtherSurfaceGets) {
    // In a mirror one sees a wall that a sun lights: all of it direct, but what the wall gets from
    // the mirror and the sky by way of other surfaces.
    TestScene scene;
    scene.materials.resize(2);
    scene.materials[1].kind = MaterialKind::kMirror;
    scene.add(Hyperplane{-Vec4::UnitZ(), -2}, Vec4::Zero(), {}, 1);
    scene.add(Hyperplane{Vec4::UnitZ(), -10}, Vec4::Zero(), {}, 0);
    Sun sun;
    sun.direction = Vec4(0, -0.6, -0.8, 0);
    sun.angle = 0;
    scene.lights.suns.push_back(sun);
    scene.settings.width = scene.settings.height = 6;
    scene.settings.integrator = Integrator::kPath;
    scene.settings.channels.light = true;
    const Image image = picture_of(scene);
    // The mirror hides the sun from the wall: the scene is dark but for what glows.
    for (const char* c : kColors)
        for (const float v : image.planes.at(channel("direct", c))) EXPECT_EQ(v, 0);
    scene.materials[0].emission = Color::Constant(0.5);
    const Image glowing = picture_of(scene);
    for (std::size_t i = 0; i < glowing.planes.at("R").size(); ++i) {
        // Emission once by way of the mirror, tinted by its albedo of 0.8.
        EXPECT_NEAR(glowing.planes.at("direct.R")[i], 0.4, 0.0004);
        // The wall sees itself in the mirror.
        EXPECT_GT(glowing.planes.at("indirect.R")[i], 0.1);
    }
}

TEST(LightLayers, OfClosedFormsAreAllDirect) {
    TestScene scene = lit_scene(true);
    scene.settings.integrator = Integrator::kDirect;
    const Image image = picture_of(scene);
    for (const char* c : kColors) {
        EXPECT_EQ(image.planes.at(channel("direct", c)), image.planes.at(c));
        for (const float v : image.planes.at(channel("indirect", c))) ASSERT_EQ(v, 0);
    }
}

TEST(LightLayers, AloneAreWhatTheyAreBesideTheColor) {
    TestScene scene = lit_scene(true);
    const Image both = picture_of(scene);
    scene.settings.channels = {false, false, false, false, true};
    scene.settings.channels.light = true;
    const Image alone = picture_of(scene);
    for (const char* c : kColors) {
        EXPECT_EQ(alone.planes.count(c), 0u);
        for (const char* layer : {"direct", "indirect"})
            EXPECT_EQ(alone.planes.at(channel(layer, c)), both.planes.at(channel(layer, c)));
    }
}

TEST(ClampedPixels, AreCountedWhereAColorIsBeyondAHalf) {
    TestScene scene;
    scene.materials.resize(2);
    scene.materials[1].emission = {1, 70000, 1};
    scene.add(Hypersphere{1}, Vec4(0, 0, 0, 0), {}, 1);
    scene.settings.width = 30, scene.settings.height = 20;
    scene.settings.tile = 8;
    const Folder folder;
    const FrameStats stats = render(scene, folder / "a.exr");
    const Image image = read_exr(folder / "a.exr");
    std::uint64_t count = 0;
    SampleNumber first;
    for (int y = 19; y >= 0; --y)
        for (int x = 29; x >= 0; --x)
            if (image.at("G", x, y) == 65504) ++count, first = {y, x, 0};
    EXPECT_GT(count, 10u);
    EXPECT_EQ(stats.clamped_pixels, count);
    EXPECT_EQ(stats.first_clamped, first);
    EXPECT_EQ(stats.invalid_samples, 0u);

    // Just below: none. Below zero: all. A color that is not stored: none.
    scene.materials[1].emission = {1, 65504, 1};
    EXPECT_EQ(render(scene, folder / "b.exr").clamped_pixels, 0u);
    scene.lights.sky = Color::Constant(-1e6);
    scene.materials[1].emission = Color::Zero();
    EXPECT_EQ(render(scene, folder / "c.exr").clamped_pixels, 600u);
    EXPECT_EQ(read_exr(folder / "c.exr").at("R", 0, 0), -65504);
    scene.settings.channels.color = false;
    EXPECT_EQ(render(scene, folder / "d.exr", folder / "d.png").clamped_pixels, 0u);
}

}  // namespace
}  // namespace tesserae::render
