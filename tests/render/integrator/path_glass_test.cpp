// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/material/dielectric.hpp"
#include "tests/render/traced_scene.hpp"

namespace tesserae::render {
namespace {

using std::numbers::pi;

TEST(Path, GlassKeepsTheFieldInsideAtTheCubeOfItsIndex) {
    // A ray that goes in shows, at the black ball in the glass, nothing; at a white one all: with
    // radiance n^3 inside, seen from outside as 1.
    TestScene scene = path_scene(100'000);
    scene.lights.sky = Color::Ones();
    scene.materials.resize(2);
    scene.materials[0].albedo = scene.materials[1].albedo = Color::Ones();
    scene.materials[0].kind = MaterialKind::kGlass;
    scene.add(Hypersphere{1}, 4 * Vec4::UnitZ());
    scene.add(Hypersphere{0.6}, 4 * Vec4::UnitZ(), {}, 1);
    expect_near(mean_radiance(TracedScene(scene), Vec4(0.05, 0, 1, 0).normalized(), 20000), 1, 0.01,
                "white");
    scene.materials[1].albedo = Color::Zero();
    const double once = std::pow(0.2, 2);
    expect_near(mean_radiance(TracedScene(scene), Vec4::UnitZ(), 20000), once, 0.01, "black");
}

TEST(Path, MagnifiedLightIsDimmedByItsVolume) {
    // A glowing black ball in the middle of a glass ball looks larger than it is. The power that
    // leaves it is the same, so its radiance falls by the cube of the magnification, which is found
    // here by moving the ray until it misses: three directions are magnified in four dimensions.
    TestScene scene = path_scene(1);
    scene.materials.resize(2);
    scene.materials[0].kind = MaterialKind::kGlass;
    scene.materials[0].albedo = Color::Ones();
    scene.materials[0].ior = 1.7;
    scene.materials[1].albedo = Color::Zero();
    scene.materials[1].emission = Color::Ones();
    const auto radiance_at = [&](double h) {
        TestScene moved = scene;
        moved.add(Hypersphere{1}, Vec4(h, 0, 4, 0));
        moved.add(Hypersphere{0.3}, Vec4(h, 0, 4, 0), {}, 1);
        return mean_radiance(TracedScene(moved), Vec4::UnitZ(), 4000);
    };
    double inside = 0, outside = 1;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (inside + outside);
        (radiance_at(middle).sum[0] > 0 ? inside : outside) = middle;
    }
    const double magnification = inside / 0.3;
    EXPECT_NEAR(magnification, 1.7, 1e-9);
    const double r = std::pow(0.7 / 2.7, 2);
    expect_near(radiance_at(0), (1 - r) / std::pow(magnification, 3), 0.01, "axis");
}

TEST(Path, LightThroughAGlassBallOnItsAxis) {
    // Of a ray through the centre R comes back at each surface: (1 - R)^2 (1 + R^2 + R^4 + ...) =
    // (1 - R)/(1 + R) goes through, and the indices' cubes cancel.
    for (Integrator integrator : {Integrator::kDirect, Integrator::kPath}) {
        TestScene scene = path_scene(100'000);
        scene.settings.integrator = integrator;
        scene.materials[0].kind = MaterialKind::kGlass;
        scene.materials[0].albedo = Color::Ones();
        scene.materials[0].ior = 2;
        scene.add(Hypersphere{1}, 4 * Vec4::UnitZ());
        scene.lights.spheres = {{9 * Vec4::UnitZ(), 0.5, Color::Constant(3)}};
        const double r = std::pow(1.0 / 3, 2);
        expect_near(mean_radiance(TracedScene(scene), Vec4::UnitZ(), 20000), 3 * (1 - r) / (1 + r),
                    0.02, "axis");
    }
}

TEST(Path, GlassBallBendsByTwiceTheDifferenceOfAngles) {
    // A ray at height h above the axis, in a plane that has a part along w: it leaves turned by
    // 2 (asin(h) - asin(h/n)) toward the axis, with (1 - R)^2 of the light. A small light stands
    // there; rays that are reflected inside leave elsewhere.
    for (double h : {0.2, 0.5, 0.8}) {
        TestScene scene = path_scene(1000);
        scene.materials[0].kind = MaterialKind::kGlass;
        scene.materials[0].albedo = Color::Ones();
        const Vec4 up = Vec4(0, 0.6, 0, 0.8);
        scene.add(Hypersphere{1}, 4 * Vec4::UnitZ() - h * up);
        const double in = std::asin(h), inside = std::asin(h / 1.5), turn = 2 * (in - inside);
        // Where it enters seen from the centre: at angle pi - in from the axis; where it leaves:
        // on by pi - 2 inside.
        const double leave = (pi - in) - (pi - 2 * inside);
        const Vec4 exit =
            scene.bodies.position[0] + std::cos(leave) * Vec4::UnitZ() + std::sin(leave) * up;
        const Vec4 way = std::cos(turn) * Vec4::UnitZ() - std::sin(turn) * up;
        scene.lights.spheres = {{exit + 6 * way, 0.001, Color::Ones()}};
        const double r = fresnel(std::cos(in), 1 / 1.5);
        expect_near(mean_radiance(TracedScene(scene), Vec4::UnitZ(), 10000), (1 - r) * (1 - r),
                    0.01, std::to_string(h));
    }
}

TEST(Path, OfOverlappingGlassesTheLastOneRules) {
    // On the axis of all bodies, with R of one surface: slabs in series send through
    // 1/(1 + sum of R/(1 - R)) (the rays' intensities add up).
    const auto through = [](std::initializer_list<double> ratios) {
        double sum = 0;
        for (double n : ratios) {
            const double r = std::pow((n - 1) / (n + 1), 2);
            sum += r / (1 - r);
        }
        return 1 / (1 + sum);
    };
    const auto found = [](std::initializer_list<std::pair<double, double>> balls, double n0,
                          double n1) {
        TestScene scene = path_scene(100'000);
        scene.materials.resize(2);
        for (Material& m : scene.materials) m.kind = MaterialKind::kGlass, m.albedo = Color::Ones();
        scene.materials[0].ior = n0, scene.materials[1].ior = n1;
        std::uint32_t material = 0;
        for (const auto& [z, radius] : balls)
            scene.add(Hypersphere{radius}, z * Vec4::UnitZ(), {}, material++);
        scene.lights.spheres = {{20 * Vec4::UnitZ(), 0.5, Color::Ones()}};
        return mean_radiance(TracedScene(scene), Vec4::UnitZ(), 20000);
    };
    // Two balls of one glass are one body, whichever comes first.
    expect_near(found({{4, 1}, {5, 1}}, 2, 2), through({2, 2}), 0.01, "one glass");
    expect_near(found({{5, 1}, {4, 1}}, 2, 2), through({2, 2}), 0.01, "one glass, turned");
    // A ball in a ball: seen if it comes later, else not there.
    expect_near(found({{4, 1}, {4, 0.5}}, 2, 3), through({2, 1.5, 1.5, 2}), 0.01, "inner rules");
    expect_near(found({{4, 0.5}, {4, 1}}, 3, 2), through({2, 2}), 0.01, "outer rules");
    // Two balls in one place: the later one alone.
    expect_near(found({{4, 1}, {4, 1}}, 3, 2), through({2, 2}), 0.01, "same place");
    // Overlapping halves: air, 2, 3, air either way.
    expect_near(found({{4, 1}, {5, 1}}, 2, 3), through({2, 1.5, 3}), 0.01, "first rules");
    expect_near(found({{5, 1}, {4, 1}}, 3, 2), through({2, 1.5, 3}), 0.01, "second rules");
}

TEST(Path, FlushFacesOfGlassLoseNoLight) {
    // Water that fills a glass to the brim: boxes whose tops lie in one plane, at any place and any
    // way round. Down through the brim and out of the bottom stand water and glass alone: slabs in
    // series again. Nothing is lost beside them either: in a white furnace all of it is unseen.
    Random random(526);
    for (int round = 0; round < 8; ++round) {
        TestScene scene = path_scene(100'000);
        scene.materials.resize(2);
        for (Material& m : scene.materials) m.kind = MaterialKind::kGlass, m.albedo = Color::Ones();
        scene.materials[0].ior = 1.5, scene.materials[1].ior = 1.33;
        const Rotor turn = random_rotor(random);
        const Mat4 axes = to_matrix(turn);
        const Vec4 down = -axes.col(1), top = 3 * down;
        scene.add(Hyperbox{Vec4::Constant(2)}, top + down, turn, 0);
        scene.add(Hyperbox{Vec4(1.8, 1.8, 1.8, 1.8)}, top + 0.9 * down, turn, 1);
        scene.lights.spheres = {{9 * down, 0.5, Color::Ones()}};
        const auto lost = [](double n) {
            return std::pow((n - 1) / (n + 1), 2) / (4 * n / std::pow(n + 1, 2));
        };
        const double through = 1 / (1 + lost(1.33) + lost(1.5 / 1.33) + lost(1.5));
        expect_near(mean_radiance(TracedScene(scene), down, 8000), through, 0.01, "brim");
        scene.lights.spheres.clear();
        scene.lights.sky = Color::Ones();
        const Vec4 aside = (top + 0.5 * random_vector(random, 1)).normalized();
        expect_near(mean_radiance(TracedScene(scene), aside, 2000), 1, 0.05, "furnace");
    }
}

}  // namespace
}  // namespace tesserae::render
