// SPDX-License-Identifier: Apache-2.0
#include "render/integrator/shading.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "render/material/pattern.hpp"
#include "render/tint.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

constexpr double kBrdf = 3 / (4 * std::numbers::pi);

/// The first surface along a direction from the world's origin, and what it sends back.
struct Shaded {
    Surface surface;
    Color radiance;
    FrameStats stats;
};
Shaded shade(const TestScene& scene, const Vec4& direction) {
    const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
    const Picture picture = scene.picture();
    const LightSet lights(picture.lights, Vec4::Zero());
    const BodyTree tree(placed);
    const RoughReflections rough(picture.materials);
    const Shading shading(picture, placed, tree, lights, rough);
    Shaded s;
    const Ray ray = {Vec4::Zero(), direction};
    s.surface = shading.surface(nearest_of_all(placed, ray, scene.settings, s.stats), ray);
    s.radiance = shading.radiance(s.surface, -direction, s.stats);
    return s;
}

TEST(Shading, PlaneIsLambertsFormula) {
    // Radiance = albedo (3/(4 pi) E cos + sky), the cosine from the sun's direction.
    Random random(41);
    for (int i = 0; i < 1000; ++i) {
        TestScene scene;
        Hyperplane plane{random_direction(random), -2};
        scene.add(plane, Vec4::Zero());
        scene.materials[0].albedo = {0.2, 0.5, 0.9};
        scene.lights.sky = {0.1, 0.2, 0.3};
        Color expected = scene.lights.sky;
        for (int k = 0; k < 3; ++k) {
            Sun sun;
            sun.direction = random_direction(random);
            sun.irradiance = Color(1, 2, 3) * (k + 1);
            sun.angle = 0;
            scene.lights.suns.push_back(sun);
            expected += kBrdf * sun.irradiance * std::max(0.0, -sun.direction.dot(plane.normal));
        }
        const Shaded s = shade(scene, -plane.normal);
        EXPECT_LT((s.radiance - scene.materials[0].albedo * expected).abs().maxCoeff(), 1e-14);
    }
}

TEST(Shading, SphereIsLambertsFormula) {
    Random random(42);
    for (int i = 0; i < 1000; ++i) {
        TestScene scene;
        const Vec4 centre = 5 * random_direction(random);
        scene.add(Hypersphere{2}, centre);
        Sun sun;
        sun.direction = random_direction(random);
        scene.lights.suns = {sun};
        const Vec4 direction = (centre + random_vector(random, 0.7)).normalized();
        const Shaded s = shade(scene, direction);
        // The hit and the normal from the quadratic equation.
        const double b = direction.dot(centre);
        const double t = b - std::sqrt(b * b - 25 + 4);
        const Vec4 normal = (t * direction - centre) / 2;
        EXPECT_NEAR(s.surface.distance, t, 1e-13);
        EXPECT_LT((s.surface.normal - normal).norm(), 1e-13);
        const double cosine = std::max(0.0, -sun.direction.dot(normal));
        EXPECT_NEAR(s.radiance[0], 0.8 * kBrdf * cosine, 1e-13);
        // No ray where the sun is behind the surface.
        EXPECT_EQ(s.stats.shadow_rays, cosine > 0 ? 1u : 0u);
    }
}

TEST(Shading, SunWithoutLightCastsNoRays) {
    TestScene scene;
    scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
    Sun dark;
    dark.irradiance = Color::Zero();
    scene.lights.suns = {dark};
    EXPECT_EQ(shade(scene, -Vec4::UnitY()).stats.shadow_rays, 0u);
}

TEST(Shading, PointLightFallsOffAsTheCubeOfTheDistance) {
    TestScene scene;
    scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
    for (double height : {0.5, 1.0, 2.0, 4.0})
        for (double aside : {0.0, 0.7}) {
            // The flux through a hypersphere of radius r is spread over its area 2 pi^2 r^3.
            scene.lights.points = {
                {Vec4(0.6, 0, 0, 0.8) * aside + (height - 1) * Vec4::UnitY(), Color(1, 2, 3)}};
            const double r = std::hypot(height, aside);
            const double expected =
                0.8 * kBrdf * (height / r) / (2 * std::numbers::pi * std::numbers::pi * r * r * r);
            const Shaded s = shade(scene, -Vec4::UnitY());
            EXPECT_NEAR(s.radiance[0], expected, 1e-14 * expected);
            EXPECT_NEAR(s.radiance[2], 3 * expected, 3e-14 * expected);
        }
}

TEST(Shading, SphereLightIsTheSineCubed) {
    TestScene scene;
    scene.materials[0].albedo = Color::Ones();
    scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
    for (double height : {1.1, 2.0, 9.0}) {
        const Vec4 aside = Vec4(0, 0, 0.6, 0.8) * 0.05 * height;
        scene.lights.spheres = {{aside + (height - 1) * Vec4::UnitY(), 1, Color::Constant(5)}};
        const double distance = std::hypot(height, aside.norm());
        const double irradiance =
            5 * 4 * std::numbers::pi / 3 * std::pow(1 / distance, 3) * height / distance;
        EXPECT_NEAR(shade(scene, -Vec4::UnitY()).radiance[0] / (kBrdf * irradiance), 1, 1e-13);
    }
    // Inside the light everything is light: a white surface sends its radiance back.
    scene.lights.spheres = {{Vec4::Zero(), 2, Color::Constant(5)}};
    EXPECT_NEAR(shade(scene, -Vec4::UnitY()).radiance[0], 5, 1e-14);
}

TEST(Shading, LeavesOutLightsThatAddLessThanATenThousandth) {
    // Many lights of very different flux, some of them shaded: held against one at a time, of which
    // none is left out.
    Random random(43);
    std::uint64_t asked = 0, all = 0;
    for (int i = 0; i < 300; ++i) {
        TestScene scene;
        scene.add(Hyperplane{Vec4::UnitY(), -2}, Vec4::Zero());
        for (int k = 0; k < 6; ++k) scene.add(Hypersphere{0.7}, random_vector(random, 3));
        scene.materials[0].albedo = {0.2, 0.5, 0.9};
        if (i % 2) scene.lights.sky = {0.01, 0.02, 0};
        const auto strength = [&] { return std::pow(10, uniform(random, -9, 2)); };
        const auto place = [&] { return Vec4(random_vector(random, 6) + 2 * Vec4::UnitY()); };
        const auto color = [&] { return Color(strength(), strength(), strength()); };
        for (int k = 0; k < 20; ++k) {
            if (i % 3 != 0) scene.lights.points.push_back({place(), color()});
            if (i % 3 != 1) scene.lights.spheres.push_back({place(), 0.3, color()});
        }
        const Vec4 down = Vec4(0.3, -1, 0.2, 0.1).normalized();
        const Shaded together = shade(scene, down);
        TestScene one = scene;
        one.lights.points.clear(), one.lights.spheres.clear();
        const Color unlit = shade(one, down).radiance;
        Color expected = unlit;
        const auto add = [&](auto& lights, const auto& light) {
            lights = {light};
            const Shaded alone = shade(one, down);
            expected += alone.radiance - unlit;
            all += alone.stats.shadow_rays;
            lights.clear();
        };
        for (const PointLight& light : scene.lights.points) add(one.lights.points, light);
        for (const SphereLight& light : scene.lights.spheres) add(one.lights.spheres, light);
        asked += together.stats.shadow_rays;
        for (int c = 0; c < 3; ++c) {
            EXPECT_LE(together.radiance[c], expected[c] * (1 + 1e-12)) << i;
            EXPECT_GE(together.radiance[c], expected[c] * (1 - 1.0001e-4)) << i;
        }
    }
    EXPECT_LT(asked, all * 3 / 4);
}

TEST(Shading, BodiesShadeALightOnlyFromBetween) {
    // A ball on the way to the light, beside it, and behind it.
    for (int kind = 0; kind < 2; ++kind)
        for (double radius : {0.3, 0.05}) {
            const auto lit = [&](const Vec4& ball) {
                TestScene scene;
                scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
                scene.add(Hypersphere{radius}, ball);
                if (kind == 0)
                    scene.lights.points = {{Vec4(0, 3, 0, 0), Color::Ones()}};
                else
                    scene.lights.spheres = {{Vec4(0, 3, 0, 0), 0.02, Color::Ones()}};
                return shade(scene, Vec4(1e-9, -1, 0, 0).normalized()).radiance[0];
            };
            const double clear = lit(Vec4(9, 9, 9, 9));
            EXPECT_GT(clear, 0);
            EXPECT_EQ(lit(Vec4(0, 0.8, 0, 0)), 0);
            EXPECT_EQ(lit(Vec4(0, 2.6, 0, 0)), 0);
            EXPECT_EQ(lit(Vec4(0, 3.4, 0, 0)), clear);
            EXPECT_EQ(lit(Vec4(0, 300, 0, 0)), clear);
            EXPECT_EQ(lit(Vec4(0, 0.8, 0, 0.5)), clear);
        }
}

TEST(Shading, EmissionIsAdded) {
    TestScene scene;
    scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
    scene.materials[0].emission = {1, 2, 3};
    scene.lights.sky = Color::Constant(0.5);
    EXPECT_TRUE((shade(scene, -Vec4::UnitY()).radiance == Color(1.4, 2.4, 3.4)).all());
}

TEST(Shading, NormalsOfTurnedBodiesAreTheGradient) {
    // Central differences of the signed distance, whose error is 1e-5^2 times curvatures of a few.
    Random random(43);
    for (int i = 0; i < 600; ++i) {
        TestScene scene;
        const Vec4 centre = 4 * random_direction(random);
        scene.add(random_shape(random, i % kShapeKinds, 1), centre, random_rotor(random));
        const Vec4 direction = centre.normalized();
        const Surface s = shade(scene, direction).surface;
        const Mat4 turn = to_matrix(scene.bodies.rotor[0]).transpose();
        const auto f = [&](const Vec4& p) {
            return std::visit(
                [&](const auto& x) { return signed_distance(x, turn * (p - centre)); },
                scene.bodies.types[0].shape);
        };
        // A little outside, where no shape has a kink.
        const Vec4 p = s.point + 0.01 * s.normal;
        for (int k = 0; k < 4; ++k) {
            const Vec4 e = 1e-5 * Vec4::Unit(k);
            EXPECT_NEAR(s.normal[k], (f(p + e) - f(p - e)) / 2e-5, 1e-7) << i;
        }
    }
}

TEST(Albedo, CheckerCellsAreCentredAndAlternate) {
    Material m;
    m.pattern = Pattern::kChecker;
    m.pattern_size = 0.5;
    EXPECT_TRUE((colour_in_space(m, Vec4::Constant(0.24)) == m.albedo).all());
    EXPECT_TRUE((colour_in_space(m, Vec4::Constant(-0.24)) == m.albedo).all());
    for (int axis = 0; axis < 4; ++axis)
        for (int n = -3; n <= 3; ++n) {
            const Color c = colour_in_space(m, 0.5 * n * Vec4::Unit(axis));
            EXPECT_TRUE((c == (n % 2 == 0 ? m.albedo : m.pattern_albedo)).all());
        }
    EXPECT_TRUE((colour_in_space(m, Vec4(0.5, 0.5, 0, 0)) == m.albedo).all());
    EXPECT_TRUE((colour_in_space(m, Vec4(0.5, 0.5, 0, -0.5)) == m.pattern_albedo).all());
}

TEST(Albedo, StripesDependOnXAlone) {
    Material m;
    m.pattern = Pattern::kStripes;
    m.pattern_size = 0.5;
    Random random(44);
    for (int i = 0; i < 1000; ++i) {
        const Vec4 p = random_vector(random, 10);
        const bool odd = std::lround(p.x() / 0.5) % 2 != 0;
        EXPECT_TRUE((colour_in_space(m, p) == (odd ? m.pattern_albedo : m.albedo)).all());
    }
}

TEST(Albedo, VariesFromBodyToBodyWithinItsBounds) {
    Color sum = Color::Zero(), squares = Color::Zero();
    constexpr int kBodies = 20'000;
    for (BodyId id = 0; id < kBodies; ++id) {
        const Color tint = tint_of(id, 0.4);
        ASSERT_TRUE((tint >= 0.6).all() && (tint <= 1).all()) << id;
        // By three quarters all colours vary alike.
        EXPECT_LE(tint.maxCoeff() - tint.minCoeff(), 0.1 + 1e-12);
        EXPECT_FALSE((tint == tint_of(id + 1, 0.4)).all()) << id;
        sum += tint, squares += tint * tint;
    }
    const Color mean = sum / kBodies, variance = squares / kBodies - mean * mean;
    // Of 0.75 u + 0.25 v, each uniform: (9 + 1) / 16 / 12.
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(mean[i], 0.8, 0.003);
        EXPECT_NEAR(variance[i], 0.16 * 10 / 192, 2e-4);
    }
}

TEST(Albedo, OfASurfaceIsThatOfItsBody) {
    TestScene scene;
    scene.materials[0].albedo = {0.5, 0.6, 0.7};
    scene.materials[0].albedo_variation = 0.5;
    for (int i = 0; i < 5; ++i) scene.add(Hypersphere{0.4}, Vec4(i - 2, 0, 5, 0));
    for (int i = 0; i < 5; ++i) {
        const Vec4 toward = scene.bodies.position[static_cast<BodyId>(i)].normalized();
        const Surface s = shade(scene, toward).surface;
        const Color tint = tint_of(static_cast<BodyId>(i), 0.5);
        EXPECT_TRUE((s.albedo == scene.materials[0].albedo * tint).all()) << i;
    }
}

TEST(Albedo, FacesOnCellBoundariesDoNotFlicker) {
    // The faces of this box lie exactly between cells 0 and 1, and those of the plane between -1
    // and 0 or so: every point of a face takes the cells just below it.
    for (int kind = 0; kind < 2; ++kind) {
        TestScene scene;
        scene.materials[0].pattern = Pattern::kChecker;
        scene.materials[0].pattern_size = 1;
        Random random(45);
        const Rotor rotor = kind == 0 ? random_rotor(random) : Rotor{};
        const Vec4 up = rotate(rotor, Vec4::UnitY());
        if (kind == 0)
            scene.add(Hyperbox{Vec4::Constant(3)}, -4 * up, rotor);
        else
            scene.add(Hyperplane{Vec4::UnitY(), -2.5}, Vec4::Zero());
        const Mat4 turn = to_matrix(rotor);
        for (int i = 0; i < 300; ++i) {
            // Below: a point of the face in the middle of cell (k, l, m) across.
            Vec4 cell(0, -2.5, 0, 0);
            int sum = kind == 0 ? 1 : 0;
            for (int axis : {0, 2, 3}) {
                const int k = static_cast<int>(random() % 3) - 1;
                cell[axis] = k + uniform(random, -0.4, 0.4);
                sum += k;
            }
            // The box's top cell has index 1 along y; the plane's pattern starts at the plane.
            const Surface s = shade(scene, (turn * cell).normalized()).surface;
            const Material& m = scene.materials[0];
            EXPECT_TRUE((s.albedo == (sum % 2 == 0 ? m.albedo : m.pattern_albedo)).all())
                << kind << " " << i;
        }
    }
}

}  // namespace
}  // namespace tesserae::render
