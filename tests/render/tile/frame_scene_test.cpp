// SPDX-License-Identifier: Apache-2.0
#include "render/tile/frame_scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "render/sampling/sampler.hpp"
#include "tests/render/test_scene.hpp"

// Whatever a filter, lens, shutter or sheet can reach is in the lists of tiles and of their
// windows.
namespace tesserae::render {
namespace {

constexpr std::array kFilterKinds = {FilterKind::kBox, FilterKind::kTriangle, FilterKind::kGaussian,
                                     FilterKind::kBlackmanHarris};

/// Small bodies of every shape, before and about the frame, some of glass and glowing.
TestScene specks(std::uint64_t seed) {
    TestScene scene = cloud(seed, 60, 2.5, 0.03, 0.3);
    scene.materials.resize(3);
    scene.materials[1].kind = MaterialKind::kGlass;
    scene.materials[2].emission = {1, 2, 3};
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        scene.bodies.position[i].w() *= 0.05;
        scene.appearance[i].material = static_cast<std::uint32_t>(i % 3);
    }
    scene.lights.sky = {0.2, 0.3, 0.4};
    Sun sun;
    sun.direction = Vec4(0.3, -1, 0.4, 0.1).normalized();
    scene.lights.suns = {sun};
    scene.camera.position = {0.3, 0.2, -5, 0};
    scene.settings.width = 44, scene.settings.height = 36;
    scene.settings.samples = scene.settings.max_samples = 4;
    scene.settings.tile = 8;
    return scene;
}

TEST(FrameScene, EveryFilterSeesWhatTryingAllBodiesSees) {
    // The coverage of every pixel, from the same samples without any list.
    int covered = 0;
    for (const FilterKind filter : kFilterKinds)
        for (const double width : {0.5, 1.0, 1.7, 4.0, 16.0}) {
            TestScene scene = specks(631);
            scene.settings.filter = filter, scene.settings.filter_width = width;
            const Image image = picture_of(scene);
            const Camera camera(scene.camera, image.width, image.height);
            const Picture picture = scene.picture();
            const PlacedBodies placed = place_bodies(picture, camera.origin());
            const PixelFilter place(filter, width);
            FrameStats stats;
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x) {
                    int hits = 0;
                    for (std::uint32_t i = 0; i < 4; ++i) {
                        const Vec2 film = Vec2(x, y) + place.place(pixel_sample(x, y, i));
                        const Ray ray = camera.to_world(
                            ViewRay{Vec3::Zero(), camera.ray_direction(film)}, kMiss);
                        if (nearest_of_all(placed, ray, scene.settings, stats)) ++hits;
                    }
                    covered += hits;
                    ASSERT_EQ(image.at("A", x, y), static_cast<float>(0.25 * hits))
                        << static_cast<int>(filter) << " " << width << ": " << x << ", " << y;
                }
        }
    EXPECT_GT(covered, 4000);  // of 126720
}

TEST(FrameScene, ASmallBodyHasItsLightWhereverItStands) {
    // A ball of 0.8 pixels, blurred over 16: the coverage of all pixels adds up to the area of its
    // picture, a disc, in the middle of a tile, beside its edges and in its corner. As so many
    // samples hit it in the mean, a sum's deviation is below their root.
    for (const FilterKind filter : {FilterKind::kBox, FilterKind::kGaussian})
        for (const Vec2& film :
             {Vec2(20, 20), Vec2(16.5, 20), Vec2(15.7, 23.9), Vec2(24.2, 15.8)}) {
            TestScene scene;
            scene.settings.width = scene.settings.height = 40;
            scene.settings.samples = 512;
            scene.settings.tile = 8;
            scene.settings.filter = filter, scene.settings.filter_width = 16;
            scene.settings.channels = {true, false, false, false, false};
            scene.camera.position = Vec4::Zero(), scene.camera.look_at = Vec4::UnitZ();
            scene.camera.field_of_view = 2;
            const double pixel = 2 * std::tan(std::numbers::pi / 180) / 40;
            scene.add(Hypersphere{0.8 * pixel},
                      Vec4((film.x() - 20) * pixel, (20 - film.y()) * pixel, 1, 0));
            const Image image = picture_of(scene);
            double sum = 0;
            for (const float a : image.planes.at("A")) sum += a;
            const double area = std::numbers::pi * 0.64, hits = 512 * area;
            EXPECT_NEAR(sum, area, 5 * area / std::sqrt(hits))
                << static_cast<int>(filter) << ": " << film.transpose();
        }
}

/// A way to look at the specks.
struct Look {
    const char* name;
    void (*apply)(TestScene&);
};
constexpr Look kLooks[] = {
    {"pinhole", [](TestScene&) {}},
    {"path", [](TestScene& s) { s.settings.integrator = Integrator::kPath; }},
    {"adaptive",
     [](TestScene& s) {
         s.settings.noise_target = 0.02, s.settings.max_samples = 12;
         s.settings.integrator = Integrator::kPath;
     }},
    {"lens", [](TestScene& s) { s.camera.aperture = 0.1; }},
    {"thick slice", [](TestScene& s) { s.camera.slice_thickness = 0.4; }},
    {"sheet", [](TestScene& s) { s.camera.slice_thickness = 0.8, s.camera.slices = 5; }},
    {"shutter",
     [](TestScene& s) {
         s.closing = s.bodies;
         for (Vec4& position : s.closing->position) position += Vec4(0.2, 0.1, 0, 0.1);
     }},
    {"inside glass",
     [](TestScene& s) {
         s.add(Hypersphere{1}, s.camera.position + Vec4(0.1, 0.2, 0.3, 0.1), {}, 1);
         s.camera.aperture = 0.05;
     }},
};

TEST(FrameScene, NoFilterMakesPixelsDependOnTilesCropOrThreads) {
    const Folder folder;
    for (const Look& look : kLooks)
        for (const FilterKind filter : kFilterKinds) {
            SCOPED_TRACE(look.name + std::to_string(static_cast<int>(filter)));
            TestScene scene = specks(632);
            scene.settings.filter = filter, scene.settings.filter_width = 9;
            look.apply(scene);
            scene.settings.tile = 512;
            render(scene, folder / "whole.exr", {}, 1);
            const Image whole = read_exr(folder / "whole.exr");
            scene.settings.tile = 8;
            render(scene, folder / "tiles.exr", {}, 3);
            const Image tiles = read_exr(folder / "tiles.exr");
            EXPECT_EQ(tiles.planes, whole.planes);
            EXPECT_EQ(tiles.ids, whole.ids);
            scene.settings.crop = Crop{13, 7, 30, 29};
            render(scene, folder / "crop.exr", {}, 2);
            const Image crop = read_exr(folder / "crop.exr");
            for (int y = 7; y < 29; ++y)
                for (int x = 13; x < 30; ++x) {
                    for (const auto& [name, plane] : crop.planes)
                        ASSERT_EQ(plane[crop.index(x, y)], whole.at(name, x, y)) << name;
                    ASSERT_EQ(crop.id(x, y), whole.id(x, y)) << x << ", " << y;
                }
        }
}

}  // namespace
}  // namespace tesserae::render
