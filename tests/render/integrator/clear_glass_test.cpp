// SPDX-License-Identifier: Apache-2.0
// Clear glass takes no light, so that in an even sky none of it is seen: all shapes, alone and in
// heaps, and what is cut off of paths between mirrors and in glass.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "tests/render/traced_scene.hpp"

namespace tesserae::render {
namespace {

constexpr std::array kIntegrators = {Integrator::kDirect, Integrator::kPath};
constexpr double kIndex = 1.5;

/// Clear glass under a sky of 1, all else as it is by default.
TestScene clear_scene(Integrator integrator) {
    TestScene scene;
    scene.settings.integrator = integrator;
    scene.settings.intersector = Intersector::kAnalytic;
    scene.lights.sky = Color::Ones();
    scene.materials[0].kind = MaterialKind::kGlass;
    scene.materials[0].albedo = Color::Ones();
    scene.materials[0].ior = kIndex;
    return scene;
}

Shape regular(RegularPolychoron which) {
    Polychoron shape;
    shape.regular = which;
    complete(shape);
    return shape;
}

/// All that is not large, with a name.
std::vector<std::pair<std::string, Shape>> shapes() {
    std::vector<std::pair<std::string, Shape>> all;
    Random random(590);
    for (int kind = 0; kind < kShapeKinds; ++kind)
        if (kind != 3) all.push_back({std::to_string(kind), random_shape(random, kind, 1)});
    all.push_back({"thin box", Hyperbox{Vec4(2, 2, 0.02, 2)}});
    all.push_back({"rod", Hyperbox{Vec4(0.1, 2, 0.1, 0.1)}});
    all.push_back({"5-cell", regular(RegularPolychoron::k5Cell)});
    all.push_back({"8-cell", regular(RegularPolychoron::k8Cell)});
    all.push_back({"16-cell", regular(RegularPolychoron::k16Cell)});
    all.push_back({"24-cell", regular(RegularPolychoron::k24Cell)});
    return all;
}

/// Expects the sky within a hundredth along rays toward bodies about 4 m along z.
/// @param near   of the rays' ends to that point, along each axis [m]
void expect_unseen(const TestScene& scene, int rays, double near, const std::string& what) {
    const TracedScene traced(scene);
    Random random(591);
    Mean mean;
    for (int i = 0; i < rays; ++i) {
        const Vec4 direction = (4 * Vec4::UnitZ() + random_vector(random, near)).normalized();
        mean.add(traced.radiance(direction, Sampler(i, 0, 0)));
    }
    EXPECT_NEAR(mean.mean()[0], 1, 0.01) << what;
    EXPECT_LE(static_cast<double>(traced.stats.cut_paths), 0.01 * rays) << what;
}

void expect_shape_unseen(const Shape& shape, int rays, const std::string& what) {
    Random random(592);
    for (const Integrator integrator : kIntegrators) {
        TestScene scene = clear_scene(integrator);
        scene.add(shape, 4 * Vec4::UnitZ(), random_rotor(random));
        expect_unseen(scene, rays, 0.6, what);
    }
}

TEST(ClearGlass, OfEveryShapeIsUnseenInAnEvenSky) {
    for (const auto& [name, shape] : shapes()) expect_shape_unseen(shape, 1000, name);
}

TEST(ClearGlassSlow, OfManyCellsIsUnseenInAnEvenSky) {
    expect_shape_unseen(regular(RegularPolychoron::k600Cell), 4000, "600-cell");
    expect_shape_unseen(regular(RegularPolychoron::k120Cell), 4000, "120-cell");
    for (const auto& [name, shape] : shapes()) expect_shape_unseen(shape, 20'000, name);
}

TEST(ClearGlass, InHeapsIsUnseenInAnEvenSky) {
    // Bodies of three indices that overlap, before the eye and all about it.
    for (const Integrator integrator : kIntegrators)
        for (const bool is_about : {false, true}) {
            TestScene scene = clear_scene(integrator);
            scene.materials.resize(3, scene.materials[0]);
            scene.materials[1].ior = 1.2, scene.materials[2].ior = 1.8;
            Random random(593);
            for (std::uint32_t i = 0; i < 12; ++i) {
                const Vec4 place = is_about ? Vec4(2.2 * random_direction(random))
                                            : Vec4(4 * Vec4::UnitZ() + random_vector(random, 0.8));
                scene.add(random_shape(random, static_cast<int>(i % kShapeKinds), 0.6), place,
                          random_rotor(random), i % 3);
            }
            expect_unseen(scene, 1500, is_about ? 20 : 1, is_about ? "about" : "before");
        }
}

TEST(ClearGlassSlow, FromInsideLittleMoreGetsInByLongerPaths) {
    // From inside a flat-faced body some rays are caught for ever: the same at any limit. The same
    // random numbers follow the same paths, so that the difference is what the limit cuts off: most
    // of a box a hundred times as wide as thick, which guides light to its rim.
    for (const auto& [name, shape] : shapes()) {
        std::array<double, 2> sums = {};
        for (const bool is_long : {false, true}) {
            TestScene scene = clear_scene(Integrator::kDirect);
            if (is_long) scene.settings.specular_bounces = 2000;
            Random random(594);
            scene.add(shape, 0.004 * random_direction(random), random_rotor(random));
            const TracedScene traced(scene);
            for (int i = 0; i < 1000; ++i)
                sums[is_long] += traced.radiance(random_direction(random), Sampler(i, 0, 0))[0];
        }
        EXPECT_GT(sums[0], 0.98 * sums[1]) << name;
        EXPECT_LE(sums[0], sums[1] * (1 + 1e-9)) << name;
    }
}

TEST(SpecularBounces, EndPathsThatNothingEnds) {
    // A room of white mirrors, closed on all sides: every path has as many rays as it may, and is
    // black and counted.
    for (const Integrator integrator : kIntegrators) {
        TestScene scene = clear_scene(integrator);
        scene.materials[0].kind = MaterialKind::kMirror;
        for (int axis = 0; axis < 4; ++axis)
            for (const double side : {1.0, -1.0})
                scene.add(Hyperplane{side * Vec4::Unit(axis), -1.5}, Vec4::Zero());
        const TracedScene traced(scene);
        Random random(595);
        for (int i = 0; i < 20; ++i)
            EXPECT_EQ(traced.radiance(random_direction(random), Sampler(i, 0, 0))[0], 0);
        EXPECT_EQ(traced.stats.cut_paths, 20u);
        EXPECT_EQ(traced.stats.bounce_rays, 20u * kUsualSpecularBounces);
    }
}

TEST(SpecularBounces, AreSoManyMirrorsOnTheWay) {
    // Between two mirrors of half the light that face each other, one of which glows: k mirrors
    // bring its emission, halved each time.
    for (const Integrator integrator : kIntegrators)
        for (const int most : {0, 1, 2, 5}) {
            TestScene scene = clear_scene(integrator);
            scene.settings.specular_bounces = most;
            scene.settings.bounces = 0;
            scene.materials[0].kind = MaterialKind::kMirror;
            scene.materials[0].albedo = Color::Constant(0.5);
            scene.materials[0].emission = Color::Ones();
            scene.add(Hyperplane{Vec4::UnitZ(), -1}, Vec4::Zero());
            scene.add(Hyperplane{-Vec4::UnitZ(), -1}, Vec4::Zero());
            const TracedScene traced(scene);
            Mean mean;
            for (int i = 0; i < 4000; ++i)
                mean.add(traced.radiance(Vec4::UnitZ(), Sampler(i % 64, i / 64, 0)));
            expect_near(mean, 2 - std::pow(0.5, most), 0.01, std::to_string(most));
        }
}

TEST(SpecularBounces, AndBouncesAreCountedApart) {
    // A matte body behind a slab of glass, which every path crosses twice a bounce: its light with
    // few bounces needs no more of them for the glass, and none is lost as long as both suffice.
    const auto seen = [](int bounces, int specular, Integrator integrator) {
        TestScene scene = clear_scene(integrator);
        scene.settings.bounces = bounces, scene.settings.specular_bounces = specular;
        scene.materials.resize(2);
        scene.materials[1].albedo = Color::Ones();
        scene.add(Hyperbox{Vec4(9, 9, 0.2, 9)}, 3 * Vec4::UnitZ());
        scene.add(Hypersphere{1}, 5 * Vec4::UnitZ(), {}, 1);
        const TracedScene traced(scene);
        Mean mean;
        for (int i = 0; i < 2000; ++i)
            mean.add(traced.radiance(Vec4::UnitZ(), Sampler(i % 64, i / 64, 0)));
        return mean.mean()[0];
    };
    // `direct` has no other bounces.
    EXPECT_EQ(seen(0, 60, Integrator::kDirect), seen(9, 60, Integrator::kDirect));
    EXPECT_LT(seen(9, 1, Integrator::kDirect), 0.1);
    EXPECT_NEAR(seen(0, 60, Integrator::kDirect), 1, 1e-9);
    // The ball sees the sky by one bounce; the slab sends a part of its light back to it.
    EXPECT_GT(seen(0, 60, Integrator::kPath), 0.85);
    EXPECT_NEAR(seen(40, 60, Integrator::kPath), 1, 0.01);
}

}  // namespace
}  // namespace tesserae::render
