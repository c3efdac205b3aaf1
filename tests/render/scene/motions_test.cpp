// SPDX-License-Identifier: Apache-2.0
// What moves while the shutter is open: where it is at a time, what holds it meanwhile, and that
// rays of any time meet it there.
#include "render/scene/motions.hpp"

#include <gtest/gtest.h>

#include "render/light/shadow.hpp"
#include "render/scene/ray_scene.hpp"
#include "render/tile/frame_scene.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// A cloud of which most bodies move and turn, some far, in three parts of unlike lengths; some
/// wait a while, some stand.
TestScene moving_cloud(std::uint64_t seed, Intersector intersector) {
    Random random(seed);
    TestScene scene = cloud(seed, 90, 3, 0.05, 0.8);
    scene.add(Hypersphere{1.5}, {3, 0, 0, 0.5});
    scene.add(Hyperbox{{3, 2.5, 3, 2.5}}, {-3, 0, 1, 0}, random_rotor(random));
    scene.settings.intersector = intersector;
    scene.camera.position = random_vector(random, 5);
    scene.materials.push_back(Material{});
    scene.materials[1].pattern = Pattern::kChecker;
    Bodies bodies = scene.bodies;
    for (const double time : {0.25, 0.3, 1.0}) {
        for (BodyId id = 0; id < bodies.size(); ++id) {
            scene.appearance[id].material = id % 2;
            if (id % 4 == 0 || (id % 4 == 1 && time < 0.3)) continue;
            bodies.position[id] += random_vector(random, id % 7 == 0 ? 3 : 0.2);
            bodies.rotor[id] = random_rotor(random);
            bodies.angular_velocity[id] = {.xy = 9, .yz = -4, .zw = uniform(random, -3, 3)};
        }
        scene.path.push_back({time, bodies, scene.camera});
    }
    return scene;
}

/// The bodies as they are at a time: a picture in which nothing moves.
TestScene at_time(const TestScene& scene, double time) {
    TestScene still = scene;
    still.path.clear();
    std::size_t i = 0;
    while (i + 1 < scene.path.size() && time >= scene.path[i].time) ++i;
    const double begin = i == 0 ? 0 : scene.path[i - 1].time, length = scene.path[i].time - begin;
    const Bodies& before = i == 0 ? scene.bodies : scene.path[i - 1].bodies;
    const Bodies& after = scene.path[i].bodies;
    const double part = (time - begin) / length;
    for (BodyId id = 0; id < scene.bodies.size(); ++id) {
        still.bodies.position[id] = (1 - part) * before.position[id] + part * after.position[id];
        const auto turn = turning(before, after, length, id);
        still.bodies.rotor[id] = turn ? turn->at(part) : before.rotor[id];
    }
    return still;
}

/// A ray at a body, or past it.
Ray aimed(Random& random, const PlacedBodies& placed) {
    const auto index = static_cast<std::size_t>(
        uniform(random, 0, static_cast<double>(placed.bodies.size()) - 0.5));
    const PlacedBody& body = placed.bodies[index];
    const Vec4 from = random_vector(random, 6);
    return {from, (body.centre + random_vector(random, body.radius) - from).normalized()};
}

class Moving : public ::testing::TestWithParam<Intersector> {};
INSTANTIATE_TEST_SUITE_P(Intersectors, Moving,
                         ::testing::Values(Intersector::kTrace, Intersector::kAnalytic));

TEST_P(Moving, RaysMeetBodiesWhereTheyAreAtTheirTime) {
    Random random(41);
    int met = 0, hidden = 0;
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
        const TestScene scene = moving_cloud(seed, GetParam());
        const Picture picture = scene.picture();
        const Vec4 origin = scene.camera.position;
        const Motions motions(picture, origin);
        for (const auto& [begin, end] : {std::pair(0.0, 0.02), std::pair(0.2, 0.7),
                                         std::pair(0.0, 1.0), std::pair(0.9, 1.0)}) {
            const PlacedBodies placed = place_bodies(picture, origin, {&motions, begin, end});
            const BodyTree tree(placed);
            const RayScene rays(placed, tree, scene.settings);
            const Shadows shadows(placed, tree);
            for (int k = 0; k < 60; ++k) {
                const double time = k < 2 ? (k == 0 ? begin : end) : uniform(random, begin, end);
                const TestScene still = at_time(scene, time);
                const Picture still_picture = still.picture();
                const PlacedBodies there = place_bodies(still_picture, origin);
                const BodyTree still_tree(there);
                FrameStats stats;
                std::vector<Ray> many(16);
                std::vector<Hit> hits(16);
                for (Ray& ray : many) {
                    ray = aimed(random, there);
                    ray.time = time;
                }
                const std::vector<Ray> asked = many;
                rays.nearest(many, hits, stats);
                for (std::size_t i = 0; i < asked.size(); ++i) {
                    const Hit exact = nearest_of_all(there, asked[i], scene.settings, stats);
                    ASSERT_EQ(hits[i].body, exact.body) << time;
                    if (exact) {
                        ASSERT_NEAR(hits[i].distance, exact.distance, 1e-9) << time;
                    }
                    ASSERT_EQ(rays.is_blocked(asked[i], stats), static_cast<bool>(exact));
                    Sun sun;
                    sun.direction = -asked[i].direction, sun.angle = 5;
                    const SunDisc light = sun_disc(sun);
                    const double seen =
                        shadows.visibility(light, asked[i].origin, kNoBody, stats, time);
                    ASSERT_NEAR(seen,
                                Shadows(there, still_tree)
                                    .visibility(light, asked[i].origin, kNoBody, stats),
                                1e-7);
                    met += static_cast<bool>(exact), hidden += seen < 1;
                }
            }
        }
    }
    EXPECT_GT(met, 3000);  // of 11520
    EXPECT_GT(hidden, 3000);
}

/// Lit by everything, of every material, half inside each other.
TestScene lit_cloud(std::uint64_t seed, Intersector intersector) {
    TestScene scene = moving_cloud(seed, intersector);
    scene.materials.resize(6);
    scene.materials[2].kind = MaterialKind::kMirror;
    scene.materials[3].kind = MaterialKind::kGlass;
    scene.materials[4].kind = MaterialKind::kRough;
    scene.materials[5].emission = {3, 2, 1};
    for (BodyId id = 0; id < scene.bodies.size(); ++id)
        scene.appearance[id].material = id % 5 == 3 ? id % 4 : id % 5;
    // Few enough lamps to be asked one by one: the choice of one sees how they are swept.
    for (const BodyId id : {5, 90, 91}) scene.appearance[id].material = 5;
    for (const double angle : {0.0, 3.0}) {
        Sun sun;
        sun.direction = Vec4(0.3, -1, 0.4, angle / 10).normalized(), sun.angle = angle;
        scene.lights.suns.push_back(sun);
    }
    scene.lights.points = {{Vec4(1, 3, -1, 0.5), Color(50, 40, 30)}};
    scene.lights.spheres = {{Vec4(-2, 2, 0, -0.3), 0.4, Color(3, 4, 5)}};
    scene.lights.sky = {0.2, 0.25, 0.3};
    return scene;
}

/// Of the light along rays at a time, with the same random numbers.
std::vector<Color> light_along(const Interval& interval, const std::vector<Ray>& rays) {
    FrameStats stats;
    std::vector<Ray> traced = rays;
    std::vector<Hit> hits(rays.size());
    std::vector<std::optional<Surface>> surfaces(rays.size());
    std::vector<ViewSample> samples;
    std::vector<Color> colors(rays.size());
    interval.integrator->scene().nearest(traced, hits, stats);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i]) surfaces[i] = interval.shading.surface(hits[i], rays[i]);
        samples.push_back(
            {surfaces[i] ? &*surfaces[i] : nullptr, rays[i], Sampler(static_cast<int>(i), 0, 0)});
    }
    PathWave wave;
    interval.integrator->radiance(samples, colors, wave, stats);
    return colors;
}

TEST_P(Moving, LightIsThatOfTheMoment) {
    Random random(43);
    int lit = 0, off = 0, count = 0;
    for (const Integrator integrator : {Integrator::kDirect, Integrator::kPath})
        for (std::uint64_t seed = 1; seed < 4; ++seed) {
            TestScene scene = lit_cloud(seed, GetParam());
            scene.settings.integrator = integrator;
            const Picture picture = scene.picture();
            const Vec4 origin = scene.camera.position;
            const Motions motions(picture, origin);
            const LightSet lights(scene.lights, origin);
            const RoughReflections rough(scene.materials);
            const Interval interval(picture, origin, {&motions, 0.2, 0.9}, lights, rough, 0);
            for (int k = 0; k < 24; ++k) {
                const double time = uniform(random, 0.2, 0.9);
                const TestScene still = at_time(scene, time);
                const Picture still_picture = still.picture();
                const Interval moment(still_picture, origin, {}, lights, rough, 0);
                std::vector<Ray> rays(64);
                for (Ray& ray : rays) {
                    ray = aimed(random, moment.placed);
                    ray.time = time;
                }
                const std::vector<Color> found = light_along(interval, rays);
                const std::vector<Color> exact = light_along(moment, rays);
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    ++count, lit += (exact[i] > 0.3).any();
                    // Rounding now and then decides whether a path goes on.
                    off += !((found[i] - exact[i]).abs() < 1e-6 * (1 + exact[i])).all();
                }
            }
        }
    EXPECT_GT(lit, count / 25);  // brighter than the sky
    EXPECT_LE(off, count / 500);
}

TEST(Motions, SweepsHoldTheBodiesAllTheWhile) {
    Random random(42);
    const TestScene scene = moving_cloud(5, Intersector::kTrace);
    const Picture picture = scene.picture();
    const Motions motions(picture, scene.camera.position);
    int moving = 0;
    for (BodyId id = 0; id < scene.bodies.size(); ++id) {
        const std::uint32_t motion = motions.of(id);
        EXPECT_EQ(motion == Motions::kStill, id % 4 == 0) << id;
        if (motion == Motions::kStill) continue;
        ++moving;
        const double radius = bounding_radius(scene.bodies.type_of(id).shape);
        for (int k = 0; k < 30; ++k) {
            double begin = uniform(random, 0, 1), end = uniform(random, 0, 1);
            if (k == 0) begin = 0, end = 1;
            if (begin > end) std::swap(begin, end);
            const Motions::Sweep sweep = motions.sweep(motion, begin, end);
            double most = 0;
            for (int i = 0; i <= 40; ++i) {
                const Pose pose = motions.pose(motion, begin + (end - begin) * i / 40);
                most = std::max(most, (pose.centre - sweep.centre).norm() + radius);
            }
            ASSERT_LE(most, sweep.radius * (1 + 1e-12));
            // Not much more than it needs: the box of three straight parts.
            ASSERT_GE(most, 0.5 * sweep.radius);
        }
    }
    EXPECT_GT(moving, 60);
}

TEST(Motions, NothingMovesWhereNothingLooksLikeIt) {
    TestScene scene;
    scene.add(Hypersphere{1}, Vec4::Zero());
    scene.add(Hyperplane{Vec4::UnitY(), -3}, Vec4::Zero());
    scene.closing = scene.bodies;
    scene.closing->rotor[0] = exp(Bivector{.xy = 1});  // a ball without a pattern
    EXPECT_TRUE(Motions(scene.picture(), Vec4::Zero()).is_empty());
    scene.materials[0].pattern = Pattern::kStripes;
    EXPECT_FALSE(Motions(scene.picture(), Vec4::Zero()).is_empty());
    scene.appearance[0].visible = false;
    EXPECT_TRUE(Motions(scene.picture(), Vec4::Zero()).is_empty());
}

}  // namespace
}  // namespace tesserae::render
