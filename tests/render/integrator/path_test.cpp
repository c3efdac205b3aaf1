// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "render/integrator/integrator.hpp"
#include "tests/render/traced_scene.hpp"

namespace tesserae::render {
namespace {

using std::numbers::pi;

TEST(Path, LoneConvexBodyInAWhiteFurnaceShowsItsAlbedo) {
    // A diffuse convex body sees nothing of itself: every sample is exact, whatever the bounces.
    Random random(521);
    for (int i = 0; i < 60; ++i) {
        TestScene scene = path_scene(i % 4);
        scene.materials[0].albedo = {0.25, 0.5, 1};
        scene.lights.sky = Color::Ones();
        const Vec4 centre = 4 * random_direction(random);
        scene.add(random_shape(random, i % kShapeKinds, 1), centre, random_rotor(random));
        const TracedScene traced(scene);
        const Color found = traced.radiance(centre.normalized(), Sampler(i, 0, 0));
        EXPECT_LT((found - scene.materials[0].albedo).abs().maxCoeff(), 1e-12);
    }
}

/// Bodies of every shape and kind but rough, one in another, all of albedo 1.
TestScene white_heap(Random& random, int bodies) {
    TestScene scene = path_scene(100'000);
    scene.lights.sky = Color::Ones();
    scene.materials.resize(5);
    for (Material& m : scene.materials) m.albedo = Color::Ones();
    scene.materials[1].kind = MaterialKind::kMirror;
    scene.materials[2].kind = scene.materials[3].kind = MaterialKind::kGlass;
    scene.materials[3].ior = 1.2;
    scene.materials[4].kind = MaterialKind::kRough;
    scene.materials[4].roughness = 0.8;
    for (int i = 0; i < bodies; ++i) {
        // One draw after the other: the order of a call's arguments is the compiler's.
        const auto material = static_cast<std::uint32_t>(random() % 5);
        const Rotor rotor = random_rotor(random);
        const Vec4 place = 4 * Vec4::UnitZ() + random_vector(random, 0.8);
        const auto kind = static_cast<int>(random() % kShapeKinds);
        scene.add(random_shape(random, kind, 0.8), place, rotor, material);
    }
    return scene;
}

void expect_white_heaps_unseen(int heaps) {
    // Nothing absorbs, so each ray brings back 1: mirrors, glass in glass, glass that stands in
    // diffuse bodies, rough ones. Only roulette and rough surfaces make noise.
    Random random(522);
    for (int i = 0; i < heaps; ++i) {
        const TracedScene traced(white_heap(random, 1 + i % 6));
        const Vec4 direction = (4 * Vec4::UnitZ() + random_vector(random, 0.6)).normalized();
        expect_near(mean_radiance(traced, direction, 2000), 1, 0.05, std::to_string(i));
    }
}

TEST(Path, HeapsOfWhiteBodiesInAWhiteFurnaceCannotBeSeen) { expect_white_heaps_unseen(18); }
TEST(PathSlow, HeapsOfWhiteBodiesInAWhiteFurnaceCannotBeSeen) { expect_white_heaps_unseen(40); }

TEST(Path, RoughBodyInAWhiteFurnaceShowsItsDirectionalAlbedo) {
    Random random(523);
    for (double roughness : {0.3, 0.7, 1.0}) {
        TestScene scene = path_scene(3);
        scene.materials[0].kind = MaterialKind::kRough;
        scene.materials[0].roughness = roughness;
        scene.materials[0].albedo = {1, 0.5, 0};
        scene.lights.sky = Color::Ones();
        scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
        const Vec4 direction = Vec4(0.5, -1, 0.3, 0.2).normalized();
        // The albedo from uniform directions of the hemisphere, area pi^2.
        const RoughReflection rough(roughness);
        const TangentFrame frame(Vec4::UnitY());
        Mean albedo;
        for (int i = 0; i < 400'000; ++i) {
            Vec4 in = random_direction(random);
            in[3] = std::abs(in[3]);
            albedo.add(rough.brdf(scene.materials[0].albedo, frame.to_local(-direction), in) *
                       (pi * pi * in[3]));
        }
        const Mean found = mean_radiance(TracedScene(scene), direction, 20000);
        EXPECT_NEAR(found.mean()[0], 1, 5 * found.sigma()[0] + 1e-3) << roughness;
        EXPECT_LT(found.sigma()[0], 0.01);
        EXPECT_NEAR(found.mean()[1], albedo.mean()[1],
                    5 * std::hypot(found.sigma()[1], albedo.sigma()[1]))
            << roughness;
        EXPECT_LT(albedo.sigma()[1], 0.01);
        EXPECT_EQ(found.mean()[2], 0);
    }
}

TEST(Path, GlowingCavitySumsItsBounces) {
    // Inside eight walls of albedo a and emission e every surface shows e (1 + a + a^2 + ...), one
    // term for what is seen, one for direct light and one for each bounce; exactly, until roulette.
    for (int bounces : {0, 1, 3, 40}) {
        TestScene scene = path_scene(bounces);
        scene.materials[0].albedo = {0.3, 0.6, 0.9};
        scene.materials[0].emission = Color::Constant(0.5);
        for (int axis = 0; axis < 4; ++axis)
            for (int side : {-1, 1})
                scene.add(Hyperplane{side * Vec4::Unit(axis), -1.0 - axis}, Vec4::Zero());
        const Mean found =
            mean_radiance(TracedScene(scene), Vec4(0.3, -0.2, 0.8, 0.4).normalized(), 4000);
        for (int c = 0; c < 3; ++c) {
            const double a = scene.materials[0].albedo[c];
            const double expected = 0.5 * (1 - std::pow(a, bounces + 2)) / (1 - a);
            EXPECT_NEAR(found.mean()[c], expected, 5 * found.sigma()[c] + 1e-12) << bounces;
        }
    }
}

TEST(Path, DirectLightIsTheClosedForms) {
    // Every light that a plane sees whole and unshaded, one at a time; sphere lights also half set.
    Random random(524);
    for (int i = 0; i < 40; ++i) {
        TestScene scene = path_scene(0);
        scene.materials[0].albedo = {0.2, 0.5, 0.9};
        scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
        Vec4 toward = random_direction(random);
        toward[1] = std::abs(toward[1]) + 0.3;
        toward.normalize();
        const bool is_hard = i % 4 < 2;
        if (i % 4 == 0) scene.lights.points = {{2 * toward, Color(1, 2, 3)}};
        if (i % 4 == 1 || i % 4 == 2) {
            Sun sun;
            sun.direction = -toward;
            sun.angle = i % 8 == 1 ? 0 : i % 8 == 5 ? 1e-120 : uniform(random, 0.01, 10);
            scene.lights.suns = {sun};
        }
        if (i % 4 == 3)
            scene.lights.spheres = {
                {(i % 8 == 3 ? 2 * toward : Vec4(toward - (1 + 0.7 * toward[1]) * Vec4::UnitY())),
                 uniform(random, 0.2, 1.2), Color(3, 2, 1)}};
        const Vec4 direction = Vec4(0.1, -1, 0.1, -0.2).normalized();
        scene.settings.integrator = Integrator::kDirect;
        const Color expected = TracedScene(scene).radiance(direction, Sampler(0, 0, 0));
        scene.settings.integrator = Integrator::kPath;
        const TracedScene traced(scene);
        if (traced.lights.first_sphere({Vec4::Zero(), direction}).sphere != LightSet::kNone)
            continue;
        const Mean found = mean_radiance(traced, direction, is_hard ? 2 : 4000);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(found.mean()[c], expected[c], 5 * found.sigma()[c] + 1e-12) << i;
            EXPECT_LE(found.sigma()[c], 0.03 * expected[c] + 1e-9) << i;
        }
    }
}

/// The reference of PathIntegrator, without mirrors and glass: one path at a time, by recursion, in
/// uniform directions of the hemisphere. No light is chosen, nothing but what the ray runs into
/// counts, every body is tried.
Color path_reference(const TracedScene& t, const Ray& ray, int scattered, Random& random) {
    const std::optional<Surface> met = t.first(ray);
    for (const SphereLight& l : t.scene.lights.spheres)
        if (ray_hit(Hypersphere{l.radius}, ray.origin - l.position, ray.direction) <
            (met ? met->distance : kMiss))
            return l.radiance;
    if (!met) {
        Color light = t.scene.lights.sky;
        for (const Sun& sun : t.scene.lights.suns) {
            const double angle = sun.angle * pi / 180;
            if (scattered > 0 && -sun.direction.dot(ray.direction) > std::cos(angle))
                light += sun.irradiance / (4 * pi / 3 * std::pow(std::sin(angle), 3));
        }
        return light;
    }
    const Surface& s = *met;
    if (scattered > t.scene.settings.bounces) return s.material->emission;
    Vec4 next = random_direction(random);
    if (next.dot(s.normal) < 0) next = -next;
    Color brdf = s.albedo * (3 / (4 * pi));
    if (s.material->kind == MaterialKind::kRough) {
        const TangentFrame frame(s.normal);
        brdf = s.rough->brdf(s.albedo, frame.to_local(-ray.direction), frame.to_local(next));
    }
    const Color from_next = path_reference(t, {s.point, next, s.body}, scattered + 1, random);
    return s.material->emission + brdf * next.dot(s.normal) * pi * pi * from_next;
}

/// Rays into a scene with every kind of light that a ray can run into, diffuse and rough bodies
/// that shade and light each other; the greatest of the 120 differences of 40 rays of two means in
/// units of its deviation stays below 4.5 with probability 0.999.
/// @param more   small lamps beside the five that there are
void expect_reference(int more, int rays) {
    Random random(525);
    TestScene scene = path_scene(2);
    scene.materials.resize(3);
    scene.materials[1].albedo = {0.9, 0.5, 0.2};
    scene.materials[1].kind = MaterialKind::kRough;
    scene.materials[1].roughness = 0.7;
    scene.materials[2].emission = {0.3, 0.1, 0.5};
    for (int i = 0; i < 8; ++i)
        scene.add(random_shape(random, i % kShapeKinds, 0.7),
                  4 * Vec4::UnitZ() + random_vector(random, 1.2), random_rotor(random),
                  static_cast<std::uint32_t>(i % 3));
    scene.add(Hyperplane{Vec4::UnitY(), -1.5}, Vec4::Zero());
    Sun sun;
    sun.direction = Vec4(0.4, -1, 0.3, 0.5).normalized();
    sun.angle = 25;
    scene.lights.suns = {sun};
    scene.lights.sky = {0.1, 0.2, 0.3};
    scene.lights.spheres = {{Vec4(1.5, 1, 2.5, 0.5), 0.6, Color(2, 2, 1)},
                            {Vec4(-1.5, 0.5, 3, -0.7), 0.5, Color(1, 3, 3)}};
    for (int i = 0; i < more; ++i) {
        const Vec4 place = 4 * Vec4::UnitZ() + random_vector(random, 2);
        if (i % 4 == 3)
            scene.lights.spheres.push_back({place, 0.3, Color(2, 1, 4)});
        else
            scene.add(random_shape(random, i % kShapeKinds, 0.3), place, random_rotor(random), 2);
    }
    const TracedScene traced(scene);
    double worst = 0, square = 0;
    int differing = 0;
    for (int i = 0; i < rays; ++i) {
        const Vec4 direction = (4 * Vec4::UnitZ() + random_vector(random, 1.5)).normalized();
        const Mean found = mean_radiance(traced, direction, 3000);
        Mean expected;
        for (int k = 0; k < 12000; ++k)
            expected.add(path_reference(traced, {Vec4::Zero(), direction}, 0, random));
        for (int c = 0; c < 3; ++c) {
            const double sigma = std::hypot(found.sigma()[c], expected.sigma()[c]);
            const double difference = found.mean()[c] - expected.mean()[c];
            if (!(sigma > 0)) {
                EXPECT_NEAR(difference, 0, 1e-12);
                continue;
            }
            ++differing;
            worst = std::max(worst, std::abs(difference) / sigma);
            square += difference * difference / (sigma * sigma);
        }
    }
    EXPECT_GT(differing, rays * 3 / 2);
    EXPECT_LT(worst, 4.5);
    // Their squares have mean 1; the channels of a ray are not independent: a third of the number.
    EXPECT_NEAR(square / differing, 1, 5 * std::sqrt(2.0 / (differing / 3.0)));
}

TEST(Path, AgreesWithItsReference) {
    expect_reference(0, 12);
    expect_reference(16, 12);
}
TEST(PathSlow, AgreesWithItsReference) {
    expect_reference(0, 40);
    expect_reference(16, 40);
}

TEST(Path, BodiesThatGlowHaveTheNoiseOfSphereLights) {
    // Found by chance they had 39 to 2661 times its variance. Lamps so small that the surface's
    // cosine is the same all over them, but for what of a box turns a corner.
    Random random(531);
    for (const double size : {0.01, 0.03, 0.1}) {
        for (int kind = 0; kind < 3; ++kind) {
            TestScene lamp = path_scene(0);
            lamp.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
            TestScene glow = lamp;
            const Vec4 place(0.5, 1.5, 3, 0.2);
            lamp.lights.spheres = {{place, size, Color::Ones()}};
            glow.materials.resize(2);
            glow.materials[1].emission = Color::Ones();
            const Shape shapes[] = {Hypersphere{size}, Hypercapsule{0.8 * size, size},
                                    Hyperbox{Vec4::Constant(1.5 * size)}};
            glow.add(shapes[kind], place, random_rotor(random), 1);
            const TracedScene traced_lamp(lamp), traced_glow(glow);
            double of_lamp = 0, of_glow = 0;
            for (const double x : {-2.0, 0.0, 0.5, 3.0}) {
                const Vec4 direction = Vec4(x, -1, 3, 0.3).normalized();
                const auto relative = [](const Mean& mean) {
                    const double part = mean.sigma()[0] / mean.mean()[0];
                    return part * part;
                };
                of_lamp += relative(mean_radiance(traced_lamp, direction, 2000));
                of_glow += relative(mean_radiance(traced_glow, direction, 2000));
            }
            EXPECT_LT(of_glow, (kind == 0 ? 1.01 : 2) * of_lamp) << size << ' ' << kind;
            EXPECT_GT(of_lamp, 0);
        }
    }
}

TEST(Path, ClampTakesFromIndirectLightOnly) {
    // A floor that a mirror's bright image of a light burns a caustic onto, under a glowing
    // ceiling.
    TestScene scene = path_scene(2);
    scene.materials.resize(3);
    scene.materials[1].kind = MaterialKind::kMirror;
    scene.materials[1].albedo = {0.9, 0.8, 0.7};
    scene.materials[2].emission = Color::Constant(0.2);
    scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
    scene.add(Hypersphere{0.6}, Vec4(0.8, -0.4, 2, 0), {}, 1);
    scene.add(Hyperplane{-Vec4::UnitY(), -3}, Vec4::Zero(), {}, 2);
    scene.lights.spheres.push_back({Vec4(-0.8, 0.8, 2, 0.3), 0.6, Color::Constant(60)});
    TestScene direct = scene, clamped = scene;
    direct.settings.bounces = direct.settings.specular_bounces = 0;
    constexpr double kMost = 0.5;
    clamped.settings.clamp_indirect = kMost;
    const TracedScene all(scene), once(direct), most(clamped);
    const Vec4 direction = Vec4(0, -1, 2, 0).normalized();
    int taken = 0;
    for (int i = 0; i < 20'000; ++i) {
        const Sampler sampler(i % 100, i / 100, 0);
        const Color free = all.radiance(direction, sampler), c = most.radiance(direction, sampler);
        // Each of two bounces adds the lights', what glows, and what its ray runs into.
        const Color added = c - once.radiance(direction, sampler);
        ASSERT_GE(added.minCoeff(), -1e-12);
        ASSERT_LE(added.maxCoeff(), 0.2 + 6 * kMost);
        const bool is_taken = (free > c + 1e-9).any();
        ASSERT_TRUE(is_taken || (free == c).all());
        taken += is_taken;
    }
    EXPECT_GT(taken, 20);
    EXPECT_LT(taken, 2000);
}

TEST(Path, MirrorsShowWhatStandsBeforeThem) {
    // A mirror on the floor, 45 degrees: the wall, the sun's disc and a sphere light, in both
    // pictures; without bounces only the lights.
    for (Integrator integrator : {Integrator::kDirect, Integrator::kPath}) {
        TestScene scene = path_scene(1);
        scene.settings.integrator = integrator;
        scene.materials.resize(2);
        scene.materials[0].kind = MaterialKind::kMirror;
        scene.materials[0].albedo = {0.5, 1, 0.25};
        scene.materials[1].emission = Color::Constant(3);
        scene.materials[1].albedo = Color::Zero();
        scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
        const Vec4 direction = Vec4(0, -1, 0, 1).normalized(), up = Vec4(0, 1, 0, 1).normalized();
        const auto seen = [&] { return TracedScene(scene).radiance(direction, Sampler(0, 0, 0)); };
        const Color tint = scene.materials[0].albedo;

        scene.lights.sky = Color::Constant(2);
        EXPECT_LT((seen() - 2 * tint).abs().maxCoeff(), 1e-13);
        Sun sun;
        sun.direction = -up;
        sun.angle = 5;
        scene.lights.suns = {sun};
        const double disc = 1 / (4 * pi / 3 * std::pow(std::sin(5 * pi / 180), 3));
        EXPECT_LT((seen() - (2 + disc) * tint).abs().maxCoeff(), 1e-13 * disc);
        scene.lights.spheres = {{Vec4(0, 2, 0, 4), 0.5, Color::Constant(7)}};
        EXPECT_LT((seen() - 7 * tint).abs().maxCoeff(), 1e-13);
        scene.add(Hypersphere{0.5}, {0, 0, 0, 2}, {}, 1);
        EXPECT_LT((seen() - 3 * tint).abs().maxCoeff(), 1e-13);
    }
}

TEST(Path, ViewRaysSeeSphereLightsInFrontOfBodies) {
    for (Integrator integrator : {Integrator::kDirect, Integrator::kPath}) {
        TestScene scene = path_scene(1);
        scene.settings.integrator = integrator;
        scene.add(Hypersphere{1}, {0, 0, 5, 0});
        scene.lights.spheres = {{Vec4(0, 0, 2, 0), 0.5, Color::Constant(7)},
                                {Vec4(0, 0, 9, 0), 3, Color::Constant(9)}};
        EXPECT_EQ(TracedScene(scene).radiance(Vec4::UnitZ(), Sampler(0, 0, 0))[0], 7);
        scene.lights.spheres[0].position[2] = 7;
        EXPECT_LT(TracedScene(scene).radiance(Vec4::UnitZ(), Sampler(0, 0, 0))[0], 7);
        // A hard look past the body.
        EXPECT_EQ(
            TracedScene(scene).radiance(Vec4(0, 0.27, 1, 0).normalized(), Sampler(0, 0, 0))[0], 9);
    }
}

TEST(Path, PathsSideBySideBringWhatEachBringsAlone) {
    // Of all materials and lights; some end at once, some in the sky, some by roulette.
    Random random(530);
    TestScene scene = path_scene(12);
    scene.materials.resize(4);
    scene.materials[1].kind = MaterialKind::kMirror;
    scene.materials[2].kind = MaterialKind::kGlass;
    scene.materials[3].kind = MaterialKind::kRough;
    for (std::uint32_t i = 0; i < 60; ++i)
        scene.add(random_shape(random, i % kShapeKinds, 1), random_vector(random, 4),
                  random_rotor(random), i % 4);
    scene.lights.suns.emplace_back();
    scene.lights.sky = Color::Constant(0.2);
    for (const Integrator integrator : {Integrator::kDirect, Integrator::kPath}) {
        scene.settings.integrator = integrator;
        if (integrator == Integrator::kPath)
            scene.lights.spheres.push_back({Vec4(1, 5, 0, 1), 1, Color(3, 2, 1)});
        const TracedScene traced(scene);
        constexpr std::size_t kPaths = 200;
        std::vector<std::optional<Surface>> met(kPaths);
        std::vector<ViewSample> samples;
        std::vector<Color> expected;
        for (std::size_t i = 0; i < kPaths; ++i) {
            const Ray ray = {Vec4::Zero(), random_direction(random)};
            const Sampler sampler(static_cast<int>(i), 0, 0);
            met[i] = traced.first(ray);
            samples.push_back({met[i] ? &*met[i] : nullptr, ray, sampler});
            expected.push_back(traced.radiance(ray.direction, sampler));
        }
        std::vector<Color> found(kPaths);
        PathWave wave;
        traced.integrator->radiance(samples, found, wave, traced.stats);
        for (std::size_t i = 0; i < kPaths; ++i)
            EXPECT_TRUE((found[i] == expected[i]).all()) << i << ": " << found[i].transpose();
    }
}

}  // namespace
}  // namespace tesserae::render
