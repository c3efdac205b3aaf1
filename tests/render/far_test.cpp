// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/render/traced_scene.hpp"

// Rays without an end, and with one: max_distance, the same for view rays, bounces and shadow rays.
namespace tesserae::render {
namespace {

using std::numbers::pi;

constexpr std::array kBothIntersectors = {Intersector::kTrace, Intersector::kAnalytic};
constexpr std::array kBothIntegrators = {Integrator::kDirect, Integrator::kPath};

TEST(Far, AnOpenFloorFillsAllBelowTheHorizon) {
    // Looking level, every sample below the middle meets the floor, however far away it is.
    for (const Intersector intersector : kBothIntersectors)
        for (const double aperture : {0.0, 0.1})
            for (const double field_of_view : {90.0, 1e-4}) {
                TestScene scene;
                scene.settings.width = 20, scene.settings.height = 40;
                scene.settings.intersector = intersector;
                scene.camera.position = {0, 2, 0, 0}, scene.camera.look_at = {0, 2, 1e9, 0};
                scene.camera.field_of_view = field_of_view;
                scene.camera.aperture = aperture;
                scene.add(Hyperplane{}, Vec4::Zero());
                const Image image = picture_of(scene);
                for (int y = 0; y < 40; ++y)
                    for (int x = 0; x < 20; ++x) {
                        ASSERT_EQ(image.at("A", x, y), y >= 20) << x << ", " << y;
                        ASSERT_EQ(image.id(x, y), y >= 20 ? 1u : 0u) << x << ", " << y;
                        if (y < 20) continue;
                        const double unit = std::tan(field_of_view * pi / 360) / 20;
                        const double u = unit * (x - 9.5), v = unit * (y - 19.5);
                        const double depth = 2 * std::sqrt(u * u + v * v + 1) / v;
                        EXPECT_NEAR(image.at("Z", x, y), depth, 1e-6 * depth);
                    }
            }
}

TEST(Far, BodiesAreSeenFromAnyDistance) {
    // A ball whose picture is a disc of 12 pixels, its distance 10 to 1e14 m: the numbers of pixels
    // whose centres it covers are the same for all.
    for (const Intersector intersector : kBothIntersectors)
        for (const double aperture : {0.0, 1e-3}) {
            std::vector<std::uint32_t> near;
            for (const double distance : {10.0, 1e3, 1e6, 1e10, 1e14}) {
                TestScene scene;
                scene.settings.width = scene.settings.height = 32;
                scene.settings.intersector = intersector;
                scene.camera.position = Vec4::Zero(), scene.camera.look_at = Vec4::UnitZ();
                scene.camera.field_of_view = 10;
                scene.camera.aperture = aperture;
                const double pixel = 2 * std::tan(5 * pi / 180) / 32;
                scene.add(Hypersphere{6.1 * pixel * distance}, {0, 0, distance, 0});
                const Image image = picture_of(scene);
                if (near.empty()) near = image.ids;
                EXPECT_EQ(image.ids, near) << distance;
                const double front = distance * (1 - 6.1 * pixel);
                EXPECT_NEAR(image.at("Z", 16, 16), front, 0.01 * front);
            }
            EXPECT_GT(std::count(near.begin(), near.end(), 1u), 100);
        }
}

TEST(Far, RaysAlongAPlaneEndSomewhere) {
    // Slopes from 1 to the least double, toward the plane and away from it, and none: as the closed
    // form says where that is finite, and light that is a number.
    TestScene scene = path_scene(3);
    scene.materials.resize(2);
    scene.materials[1].pattern = Pattern::kChecker;
    scene.add(Hyperplane{Vec4::UnitY(), -2}, Vec4::Zero(), {}, 1);
    scene.add(Hypersphere{1}, {3, -1, 4, 0});
    Sun sun;
    sun.direction = Vec4(0.3, -1, 0.2, 0.1).normalized();
    sun.angle = 3;
    scene.lights.suns = {sun};
    scene.lights.points = {{Vec4(0, 5, 0, 0), Color::Ones()}};
    scene.lights.spheres = {{Vec4(0, 9, 3, 0), 1, Color::Ones()}};
    scene.lights.sky = Color::Ones();
    for (const Integrator integrator : kBothIntegrators)
        for (const Intersector intersector : kBothIntersectors) {
            scene.settings.integrator = integrator;
            scene.settings.intersector = intersector;
            const TracedScene traced(scene);
            for (int power = 0; power <= 324; ++power)
                for (const double side : {-1.0, 1.0}) {
                    const double slope = power == 324 ? 0 : side * std::pow(10, -power);
                    const Vec4 direction = Vec4(0.6, slope, 0.8, 0).normalized();
                    const Ray ray = {Vec4::Zero(), direction};
                    const double found =
                        hit_distance(traced.placed, 0, ray, scene.settings, traced.stats);
                    const double exact = slope < 0 ? 2 / -direction.y() : kMiss;
                    if (exact < 1e12) {
                        EXPECT_NEAR(found, exact, 1e-2 * exact) << slope;
                    } else {
                        EXPECT_GE(found, 1e11) << slope;  // no NaN, nothing near
                    }
                    const Color light = traced.radiance(direction, Sampler(power, 0, 0));
                    EXPECT_TRUE(light.isFinite().all() && (light >= 0).all()) << slope;
                    EXPECT_GT(light.maxCoeff(), 0.1) << slope;
                }
            EXPECT_EQ(traced.stats.unresolved, 0u);
        }
}

/// What a ray along z brings, by samples.
double light_ahead(const TestScene& scene) {
    return mean_radiance(TracedScene(scene), Vec4::UnitZ(), 64).mean()[0];
}

TEST(Far, TheLimitHoldsForShadows) {
    // A body that shades what is 30 m away from it.
    for (const Integrator integrator : kBothIntegrators)
        for (const double angle : {0.0, 2.0})
            for (const bool is_point : {false, true}) {
                TestScene scene = path_scene(0);
                scene.settings.integrator = integrator;
                scene.add(Hyperplane{-Vec4::UnitZ(), -10}, Vec4::Zero());
                scene.add(Hypersphere{4}, {18, 0, -14, 0});
                Sun sun;
                sun.direction = Vec4(-0.6, 0, 0.8, 0), sun.angle = angle;
                if (is_point)
                    scene.lights.points = {{{60, 0, -70, 0}, Color::Constant(1e6)}};
                else
                    scene.lights.suns = {sun};
                scene.settings.max_distance = 0;
                EXPECT_EQ(light_ahead(scene), 0);
                scene.settings.max_distance = 40;
                EXPECT_EQ(light_ahead(scene), 0);
                scene.settings.max_distance = 20;
                EXPECT_GT(light_ahead(scene), 0.005);
            }
}

TEST(Far, TheLimitHoldsForTheLightOfBodies) {
    // A ball that glows 30 m from a floor, which finds it by choice and, with a bounce, by chance.
    for (const int bounces : {0, 1}) {
        TestScene scene = path_scene(bounces);
        scene.materials.resize(2);
        scene.materials[1].emission = Color::Constant(100);
        scene.materials[1].albedo = Color::Zero();
        scene.add(Hyperplane{-Vec4::UnitZ(), -10}, Vec4::Zero());
        scene.add(Hypersphere{4}, {18, 0, -14, 0}, {}, 1);
        const double all = light_ahead(scene);
        EXPECT_GT(all, 0.01);
        scene.settings.max_distance = 40;
        EXPECT_EQ(light_ahead(scene), all);
        scene.settings.max_distance = 20;
        EXPECT_EQ(light_ahead(scene), 0);
    }
}

TEST(Far, TheLimitHoldsForViewRaysBouncesAndGlass) {
    // What glows stands 20 m from the camera; 10 m from it a mirror or a floor that shows it, or
    // the far side of glass that the camera is in. Sphere lights are seen however far they are.
    struct Way {
        const char* name;
        std::array<double, 2> lengths;  ///< a limit between them makes a difference
        void (*add)(TestScene&);
    };
    const Way ways[] = {{"view",
                         {15, 25},
                         [](TestScene& s) {
                             s.add(Hypersphere{5}, {0, 0, 25, 0}, {}, 1);
                         }},
                        {"mirror",
                         {25, 35},
                         [](TestScene& s) {
                             s.add(Hyperplane{-Vec4::UnitZ(), -10}, Vec4::Zero(), {}, 2);
                             s.add(Hypersphere{5}, {0, 0, -25, 0}, {}, 1);
                         }},
                        {"glass", {8, 12}, [](TestScene& s) {
                             s.add(Hypersphere{10}, Vec4::Zero(), {}, 3);
                             s.add(Hypersphere{5}, {0, 0, 15.1, 0}, {}, 1);
                         }}};
    for (const Way& way : ways)
        for (const Integrator integrator : kBothIntegrators)
            for (const Intersector intersector : kBothIntersectors) {
                TestScene scene = path_scene(4);
                scene.settings.integrator = integrator;
                scene.settings.intersector = intersector;
                scene.materials.resize(4);
                scene.materials[1].emission = Color::Ones();
                scene.materials[2].kind = MaterialKind::kMirror;
                scene.materials[3].kind = MaterialKind::kGlass;
                way.add(scene);
                const auto light_at = [&](double limit) {
                    scene.settings.max_distance = limit;
                    const TracedScene traced(scene);
                    return mean_radiance(traced, Vec4::UnitZ(), 64).mean()[0];
                };
                EXPECT_GT(light_at(0), 0.5) << way.name;
                EXPECT_EQ(light_at(way.lengths[1]), light_at(0)) << way.name;
                EXPECT_EQ(light_at(way.lengths[0]), 0) << way.name;
                scene.lights.spheres = {{{0, 0, 1000, 0}, 300, Color::Constant(7)}};
                if (std::string(way.name) == "view") {
                    EXPECT_EQ(light_at(way.lengths[0]), 7);
                }
            }
}

}  // namespace
}  // namespace tesserae::render
