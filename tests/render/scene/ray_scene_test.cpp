// SPDX-License-Identifier: Apache-2.0
#include "render/scene/ray_scene.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

struct Rays {
    int traced = 0, hit = 0;
    std::vector<Ray> all;  ///< to be traced once more, side by side
    std::vector<Hit> expected;
};

/// Compares one ray both ways, with and without a limit and a body left out.
void compare(const TestScene& scene, const PlacedBodies& placed, const RayScene& rays,
             const Ray& ray, Rays& count) {
    FrameStats stats;
    const Hit expected = nearest_of_all(placed, ray, scene.settings, stats);
    const Hit hit = rays.nearest(ray, stats);
    const auto is_as_expected = [&] {
        return hit.distance == expected.distance && hit.body == expected.body &&
               rays.is_blocked(ray, stats) == bool(expected);
    };
    ASSERT_TRUE(is_as_expected()) << ray.origin.transpose() << " toward "
                                  << ray.direction.transpose() << ": body " << hit.body << " at "
                                  << hit.distance;
    ++count.traced;
    count.hit += expected ? 1 : 0;
    count.all.push_back(ray);
    count.expected.push_back(expected);
}

/// Side by side every ray meets what it meets alone, whoever goes with it.
void compare_side_by_side(const RayScene& rays, Rays& count) {
    FrameStats stats;
    std::vector<Hit> hits(count.all.size());
    std::vector<std::uint8_t> blocked(hits.size(), 2);
    for (std::size_t begin = 0, size = 1; begin < hits.size(); begin += size) {
        size = std::min(begin % 40 + 1, hits.size() - begin);
        rays.find_blocked(std::span(count.all).subspan(begin, size),
                          std::span(blocked).subspan(begin, size), stats);
        rays.nearest(std::span(count.all).subspan(begin, size),
                     std::span(hits).subspan(begin, size), stats);
    }
    for (std::size_t i = 0; i < hits.size(); ++i) {
        ASSERT_EQ(blocked[i], count.expected[i] ? 1 : 0) << i;
        ASSERT_EQ(hits[i].distance, count.expected[i].distance) << i;
        ASSERT_EQ(hits[i].body, count.expected[i].body) << i;
    }
    count.all.clear();
    count.expected.clear();
}

/// Directions of all kinds: anywhere, along one, two or three axes, and nearly so.
Vec4 any_direction(Random& random) {
    Vec4 d = random_direction(random);
    for (int axis = 0; axis < 4; ++axis) {
        const double kind = uniform(random, 0, 4);
        if (kind < 0.8) d[axis] = 0;
        if (kind > 3.6) d[axis] *= 1e-25;
        if (kind > 3.8) d[axis] = -0.0;
    }
    if (!(d.norm() > 1e-3)) d = (uniform(random, 0, 1) < 0.5 ? -1 : 1) * Vec4::Unit(random() % 4);
    return d.normalized();
}

void compare_many(TestScene& scene, std::uint64_t seed, int rays_each, double spread, Rays& count) {
    Random random(seed);
    const PlacedBodies placed = place_bodies(scene.picture(), scene.camera.position);
    const BodyTree tree(placed);
    for (const Intersector intersector : {Intersector::kAnalytic, Intersector::kTrace}) {
        scene.settings.intersector = intersector;
        const RayScene rays(placed, tree, scene.settings);
        const auto bodies = static_cast<std::uint32_t>(placed.bodies.size());
        for (int i = 0; i < rays_each; ++i) {
            Vec4 origin = random_vector(random, spread) - scene.camera.position;
            Vec4 direction = any_direction(random);
            // Half of the rays start at a body's centre or a side of its box, or aim at a body.
            const PlacedBody& body = placed.bodies[random() % bodies];
            const bool bounded = body.radius < kMiss;
            if (i % 4 == 0 && bounded) direction = (body.centre - origin).normalized();
            if (i % 4 == 1 && bounded) {
                origin = body.centre;
                origin[static_cast<int>(random() % 4)] += (i % 8 < 4 ? -1 : 1) * body.radius;
            }
            const double limit = i % 3 == 0 ? uniform(random, 0, spread) : kMiss;
            const std::uint32_t on =
                i % 5 == 0 ? static_cast<std::uint32_t>(random() % bodies) : kNoBody;
            compare(scene, placed, rays, {origin, direction, on, limit}, count);
            if (::testing::Test::HasFatalFailure()) return;
        }
        compare_side_by_side(rays, count);
        if (::testing::Test::HasFatalFailure()) return;
    }
}

void expect_what_all_bodies_give(int rays) {
    Rays count;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        TestScene scene = cloud(seed, 20 + 40 * static_cast<int>(seed), 4, 0.1, 0.8);
        if (seed % 3 == 0) scene.add(Hyperplane{Vec4::UnitY(), -2}, Vec4::Zero());
        compare_many(scene, 50 + seed, rays, 5, count);
        if (::testing::Test::HasFatalFailure()) return;
    }
    EXPECT_EQ(count.traced, 24 * rays);
    EXPECT_GT(count.hit, 8 * rays);
}

TEST(RayScene, FindsWhatTryingAllBodiesFinds) { expect_what_all_bodies_give(1500); }
TEST(RaySceneSlow, FindsWhatTryingAllBodiesFinds) { expect_what_all_bodies_give(5000); }

TEST(RayScene, FindsTinyBodiesAmongHugeOnes) {
    // Sizes of 1 to 10^6; the tree's fifth key is there for them.
    Rays count;
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        TestScene scene = cloud(70 + seed, 200, 3, 1e-4, 0.3);
        scene.add(Hypersphere{100}, {0, 0, 0, 103});
        scene.add(Hyperbox{{300, 1, 300, 300}}, {0, -4, 0, 0});
        compare_many(scene, 80 + seed, 3000, 4, count);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(count.hit, 15000);
}

void expect_bodies_of_trees_with_many_nodes(int rays) {
    // More nodes of a level than rays test in one go.
    Rays count;
    TestScene scene = cloud(60, 4000, 4, 0.1, 0.4);
    compare_many(scene, 61, rays, 5, count);
    EXPECT_GT(count.hit, 2 * rays / 3);
}

TEST(RayScene, FindsBodiesOfTreesWithManyNodes) { expect_bodies_of_trees_with_many_nodes(500); }
TEST(RaySceneSlow, FindsBodiesOfTreesWithManyNodes) {
    expect_bodies_of_trees_with_many_nodes(1500);
}

TEST(RayScene, FarFromTheCamera) {
    // 10^5 m, where a float is good to 8 mm.
    Rays count;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        TestScene scene = cloud(90 + seed, 150, 3, 0.01, 0.5);
        Random random(seed);
        scene.camera.position = 1e5 * random_direction(random);
        compare_many(scene, 95 + seed, 4000, 4, count);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(count.hit, 6000);
}

TEST(RayScene, BodiesInOnePlaceAndOnAGrid) {
    // A hundred bodies in one place: nothing tells them apart, and the lowest id wins. Unit boxes
    // on a grid: rays along their shared sides.
    TestScene heap, grid;
    for (int i = 0; i < 100; ++i) heap.add(Hypersphere{1}, {0, 0, 3, 0});
    for (int i = 0; i < 256; ++i)
        grid.add(Hyperbox{Vec4::Ones()}, Vec4(i & 3, i >> 2 & 3, i >> 4 & 3, i >> 6));
    Rays count;
    compare_many(heap, 1, 3000, 4, count);
    if (HasFatalFailure()) return;
    const int in_heap = count.hit;
    EXPECT_GT(in_heap, 1500);
    const PlacedBodies placed = place_bodies(grid.picture(), Vec4::Zero());
    const BodyTree tree(placed);
    const RayScene rays(placed, tree, grid.settings);
    Random random(5);
    for (int i = 0; i < 20000; ++i) {
        Vec4 origin;
        for (int k = 0; k < 4; ++k) origin[k] = 0.5 * static_cast<double>(random() % 13) - 1;
        const Vec4 direction = i % 2 == 0 ? any_direction(random)
                                          : Vec4((i % 4 == 1 ? -1 : 1) * Vec4::Unit(random() % 4));
        compare(grid, placed, rays, {origin, direction}, count);
        if (HasFatalFailure()) return;
    }
    compare_side_by_side(rays, count);
    EXPECT_GT(count.hit - in_heap, 5000);
}

TEST(RayScene, NoBodiesOneBodyOnlyPlanes) {
    for (const int kind : {0, 1, 2}) {
        TestScene scene;
        if (kind == 1) scene.add(Hypersphere{1}, {0, 0, 5, 0});
        if (kind == 2) scene.add(Hyperplane{-Vec4::UnitZ(), -4}, Vec4::Zero());
        const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
        const BodyTree tree(placed);
        const RayScene rays(placed, tree, scene.settings);
        FrameStats stats;
        const Hit hit = rays.nearest({Vec4::Zero(), Vec4::UnitZ()}, stats);
        EXPECT_EQ(hit.distance, kind == 0 ? kMiss : 4);
        EXPECT_EQ(rays.is_blocked({Vec4::Zero(), Vec4::UnitZ()}, stats), kind != 0);
        EXPECT_FALSE(rays.nearest({Vec4::Zero(), -Vec4::UnitZ()}, stats));
        EXPECT_FALSE(rays.nearest({Vec4::Zero(), Vec4::UnitZ(), kNoBody, 3.9}, stats));
        if (kind != 0) {
            EXPECT_FALSE(rays.nearest({Vec4::Zero(), Vec4::UnitZ(), 0}, stats));
        }
    }
}

TEST(BodyTree, TheSameForAnyNumberOfThreads) {
    TestScene scene = cloud(7, 6000, 10, 0.01, 1);
    for (int i = 0; i < 1000; ++i) scene.add(Hypersphere{0.1}, Vec4::Ones());
    const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
    const auto built_by = [&](int threads) {
        const tbb::global_control more(tbb::global_control::max_allowed_parallelism, 8);
        tbb::task_arena arena(threads);
        return arena.execute([&] { return BodyTree(placed).fingerprint(); });
    };
    const std::uint64_t serial = built_by(1);
    for (const int threads : {2, 3, 8})
        for (int i = 0; i < 5; ++i) EXPECT_EQ(built_by(threads), serial) << threads;
    // Another scene has another fingerprint: it can fail.
    scene.bodies.position[17][2] += 1;
    EXPECT_NE(BodyTree(place_bodies(scene.picture(), Vec4::Zero())).fingerprint(), serial);
}

}  // namespace
}  // namespace tesserae::render
