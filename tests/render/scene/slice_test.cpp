// SPDX-License-Identifier: Apache-2.0
#include "render/scene/slice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <set>
#include <utility>

#include "render/camera/camera.hpp"
#include "render/scene/film_list.hpp"
#include "render/scene/intersect.hpp"
#include "render/tile/tiles.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

TestScene slice_cloud(std::uint64_t seed, int count, double spread, bool spheres_only) {
    Random random(seed);
    TestScene scene;
    for (int i = 0; i < count; ++i)
        scene.add(
            random_shape(random, spheres_only ? 0 : i % kShapeKinds, uniform(random, 0.1, 0.8)),
            random_vector(random, spread), random_rotor(random));
    return scene;
}

std::set<std::uint32_t> bodies_of(const std::vector<SliceBounds>& slice) {
    std::set<std::uint32_t> bodies;
    for (const SliceBounds& s : slice) bodies.insert(s.body);
    return bodies;
}

TEST(SliceBounds, LeaveOutBodiesThatMissTheSlice) {
    // A sphere of radius 1 with its centre off by w: in the slice while |w| < 1.
    TestScene scene;
    for (double w : {-1.001, -0.999, 0.0, 0.999, 1.001}) scene.add(Hypersphere{1}, {0, 0, 0, w});
    // Boxes of half side 1, upright and turned by 45 degrees in zw: half width sqrt(2).
    for (double angle : {0.0, std::numbers::pi / 4})
        scene.add(Hyperbox{Vec4::Constant(2)}, {0, 0, 0, 1.2},
                  exp(-0.5 * angle * Bivector{0, 0, 0, 0, 0, 1}));
    const Camera camera(scene.camera, 100, 100);
    const PlacedBodies placed = place_bodies(scene.picture(), camera.origin());
    EXPECT_EQ(bodies_of(slice_bounds(placed, camera, 200)), (std::set<std::uint32_t>{1, 2, 3, 6}));
}

TEST(SliceBounds, InvisibleBodiesAreNotPlaced) {
    TestScene scene;
    for (int i = 0; i < 3; ++i) scene.add(Hypersphere{1}, {0, 0, 0, 0});
    scene.appearance[1].visible = false;
    const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
    ASSERT_EQ(placed.bodies.size(), 2u);
    EXPECT_EQ(placed.bodies[1].id, 2u);
}

TEST(SliceBounds, HoldEveryHit) {
    // Rays to random points of the slice: whatever body is hit is listed, the hit point lies in its
    // sphere, no nearer than `nearest`, and its film point in the rectangle.
    Random random(21);
    std::size_t hit_count = 0;
    for (int round = 0; round < 30; ++round) {
        TestScene scene = slice_cloud(100 + static_cast<std::uint64_t>(round), 150, 2, false);
        // Now and then from far outside, from within, and far from the world's origin.
        scene.camera = random_camera(random, round % 3 == 0 ? 1 : 8);
        if (round % 5 == 4) {
            const Vec4 shift = random_vector(random, 1e4);
            for (Vec4& p : scene.bodies.position) p += shift;
            scene.camera.position += shift, scene.camera.look_at += shift;
        }
        scene.camera.field_of_view = 100;
        const Camera camera(scene.camera, 200, 100);
        const PlacedBodies placed = place_bodies(scene.picture(), camera.origin());
        const std::vector<SliceBounds> slice = slice_bounds(placed, camera, 200);
        FrameStats stats;
        for (int i = 0; i < 1000; ++i) {
            const Vec2 film(uniform(random, 0, 200), uniform(random, 0, 100));
            const Vec3 view = camera.ray_direction(film);
            const Vec4 world = camera.to_world({view.x(), view.y(), view.z(), 0});
            for (std::uint32_t b = 0; b < placed.bodies.size(); ++b) {
                const double t = hit_distance(placed, b, {Vec4::Zero(), world, kNoBody, 200},
                                              scene.settings, stats);
                if (t == kMiss) continue;
                ++hit_count;
                const auto s = std::find_if(slice.begin(), slice.end(),
                                            [&](const auto& x) { return x.body == b; });
                ASSERT_NE(s, slice.end());
                EXPECT_LE((t * view - s->centre).norm(), s->radius);
                EXPECT_TRUE((t * view - s->low).minCoeff() >= 0);
                EXPECT_TRUE((s->high - t * view).minCoeff() >= 0);
                EXPECT_GE(t, s->nearest);
                EXPECT_TRUE(s->x0 <= film.x() && film.x() <= s->x1);
                EXPECT_TRUE(s->y0 <= film.y() && film.y() <= s->y1);
            }
        }
    }
    EXPECT_GT(hit_count, 10000u);
}

TEST(SliceBounds, RectangleTouchesTheSphere) {
    // The rectangle is not only safe but tight: 1 m at 8 m is seen under asin(1/8).
    TestScene scene;
    scene.add(Hypersphere{1}, Vec4::Zero());
    scene.camera.position = {0, 0, -8, 0};
    scene.camera.field_of_view = 90;
    const Camera camera(scene.camera, 200, 200);
    const auto slice = slice_bounds(place_bodies(scene.picture(), camera.origin()), camera, 200);
    const double half = 100 * std::tan(std::asin(1.0 / 8));
    ASSERT_EQ(slice.size(), 1u);
    EXPECT_NEAR(slice[0].x0, 100 - half, 1e-4);
    EXPECT_NEAR(slice[0].y1, 100 + half, 1e-4);
}

/// How far a body's slices at `range` reach along an axis of the camera: the farthest of many
/// support points that lie in the slice, joined pairwise from both sides of it.
double sampled_extent(const Hyperbox& box, const Rotor& rotor, int axis, const SliceRange& range) {
    // A slice's farthest point lies on an edge of the box: try where each leaves the range.
    const Mat4 turn = to_matrix(rotor);
    double best = -kMiss;
    for (int edge = 0; edge < 4; ++edge)
        for (int corner = 0; corner < 16; ++corner) {
            Vec4 from = 0.5 * box.size;
            for (int k = 0; k < 4; ++k)
                if (corner >> k & 1) from[k] = -from[k];
            Vec4 to = from;
            to[edge] = -to[edge];
            from = turn * from, to = turn * to;
            for (const double w : {from[3], range.low, range.high}) {
                if (w < range.low || w > range.high) continue;
                const double part = (w - from[3]) / (to[3] - from[3]);
                if (part >= 0 && part <= 1)
                    best = std::max(best, from[axis] + part * (to[axis] - from[axis]));
            }
        }
    return best;
}

TEST(SliceBounds, BoxIsTheSlicesOwn) {
    // Within 0.2 % of the body, for one slice and for a range of them.
    Random random(23);
    int compared = 0;
    for (int round = 0; round < 400; ++round) {
        TestScene scene;
        const Hyperbox box{random_vector(random, 1).cwiseAbs() + Vec4::Constant(0.05)};
        const Rotor rotor = random_rotor(random);
        scene.add(box, {0, 0, 0, 0}, rotor);
        scene.camera.position = {0, 0, -8, 0};
        const Camera camera(scene.camera, 100, 100);
        SliceRange range = {uniform(random, -0.7, 0.7), 0};
        range.high = range.low + (round % 2 == 0 ? 0 : 0.4);
        const auto slice =
            slice_bounds(place_bodies(scene.picture(), camera.origin()), camera, 200, range);
        if (slice.empty()) continue;
        for (int axis = 0; axis < 3; ++axis) {
            const double extent = sampled_extent(box, rotor, axis, range);
            // The last sliver of a slice may be missed by both or by one.
            if (extent == -kMiss) continue;
            const double high = slice[0].high[axis] - slice[0].centre[axis];
            EXPECT_GE(high, extent) << round;
            EXPECT_LE(high, extent + 0.002 * box.size.norm()) << round;
            ++compared;
        }
    }
    EXPECT_GT(compared, 500);
}

TEST(TileSource, CoversTheWindowOnceAlongACurve) {
    for (const Crop& window : {Crop{0, 0, 128, 128}, Crop{0, 0, 100, 37}, Crop{5, 9, 6, 10},
                               Crop{13, 7, 500, 20}, Crop{1, 2, 90, 400}})
        for (int side : {8, 16, 33}) {
            TileSource source({}, window, side);
            std::vector<int> seen(static_cast<std::size_t>(window.x1 * window.y1));
            while (const auto tile = source.next()) {
                EXPECT_EQ(tile->x0, window.x0 + tile->column * side);
                EXPECT_EQ(tile->y0, window.y0 + tile->row * side);
                EXPECT_LE(tile->x1 - tile->x0, side);
                EXPECT_LE(tile->y1 - tile->y0, side);
                for (int y = tile->y0; y < tile->y1; ++y)
                    for (int x = tile->x0; x < tile->x1; ++x)
                        ++seen[static_cast<std::size_t>(y * window.x1 + x)];
            }
            for (int y = 0; y < window.y1; ++y)
                for (int x = 0; x < window.x1; ++x)
                    ASSERT_EQ(seen[static_cast<std::size_t>(y * window.x1 + x)],
                              x >= window.x0 && y >= window.y0);
        }
}

TEST(TileSource, NeighboursInTheOrderAreNeighboursOnTheFilm) {
    TileSource source({}, {0, 0, 512, 512}, 8);
    auto last = source.next();
    int count = 1;
    while (auto tile = source.next()) {
        EXPECT_EQ(std::abs(tile->column - last->column) + std::abs(tile->row - last->row), 1);
        last = std::move(tile);
        ++count;
    }
    EXPECT_EQ(count, 64 * 64);
}

TEST(TileSource, ListsLoseNoBody) {
    // Every body that a ray of a tile hits, found by trying all bodies, is in the tile's list.
    Random random(22);
    std::size_t hit_count = 0;
    for (int round = 0; round < 10; ++round) {
        TestScene scene = slice_cloud(200 + static_cast<std::uint64_t>(round), 100, 2, false);
        scene.add(Hyperplane{Vec4::UnitY(), -2}, Vec4::Zero());
        scene.camera = random_camera(random, 6);
        const Camera camera(scene.camera, 96, 64);
        const PlacedBodies placed = place_bodies(scene.picture(), camera.origin());
        const std::vector<SliceBounds> slice = slice_bounds(placed, camera, 200);
        TileSource source(slice, {0, 0, 96, 64}, 16);
        FrameStats stats;
        while (const auto tile = source.next()) {
            FilmList list;
            list.fill(slice, tile->candidates, {tile->x0, tile->y0, tile->x1, tile->y1});
            for (std::size_t i = 1; i < tile->candidates.size(); ++i)
                EXPECT_LE(slice[tile->candidates[i - 1]].nearest,
                          slice[tile->candidates[i]].nearest);
            for (int i = 0; i < 40; ++i) {
                const Vec2 film(uniform(random, tile->x0, tile->x1),
                                uniform(random, tile->y0, tile->y1));
                const Vec3 view = camera.ray_direction(film);
                const Ray ray =
                    camera.to_world(ViewRay{Vec3::Zero(), view}, scene.settings.ray_limit());
                const Hit best = nearest_of_all(placed, ray, scene.settings, stats);
                const Hit hit = list.nearest(placed, view, ray, scene.settings, stats);
                hit_count += hit ? 1 : 0;
                EXPECT_EQ(hit.distance, best.distance);
                EXPECT_EQ(hit.body, best.body);
            }
        }
    }
    EXPECT_GT(hit_count, 3000u);
}

}  // namespace
}  // namespace tesserae::render
