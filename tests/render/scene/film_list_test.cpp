// SPDX-License-Identifier: Apache-2.0
#include "render/scene/film_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "render/camera/camera.hpp"
#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

std::vector<std::uint32_t> by_distance(const std::vector<SliceBounds>& slice) {
    std::vector<std::uint32_t> list(slice.size());
    std::iota(list.begin(), list.end(), 0u);
    std::sort(list.begin(), list.end(),
              [&](auto a, auto b) { return slice[a].nearest < slice[b].nearest; });
    return list;
}

TEST(FilmList, FindsWhatTryingAllBodiesFinds) {
    // From within a cloud and from afar, sizes of 1 to 10^4, planes, both intersectors.
    Random random(41);
    int hit_count = 0;
    for (int round = 0; round < 24; ++round) {
        TestScene scene;
        for (int i = 0; i < 150; ++i)
            scene.add(random_shape(random, i % kShapeKinds, std::exp(uniform(random, -9, 0))),
                      random_vector(random, 2), random_rotor(random));
        if (round % 3 == 0) scene.add(Hyperplane{Vec4::UnitY(), -2}, Vec4::Zero());
        scene.camera = random_camera(random, round % 4 == 0 ? 1 : round % 4 == 1 ? 1e5 : 6);
        if (round % 4 == 1) scene.camera.field_of_view = 0.003;
        scene.settings.max_distance = 1e6;
        scene.settings.intersector = round % 2 == 0 ? Intersector::kTrace : Intersector::kAnalytic;
        const Camera camera(scene.camera, 32, 32);
        const PlacedBodies placed = place_bodies(scene.picture(), camera.origin());
        const auto slice = slice_bounds(placed, camera, scene.settings.max_distance);
        const auto all = by_distance(slice);
        FrameStats stats;
        FilmList list;
        for (int window = 0; window < 16; ++window) {
            const int x0 = window % 4 * 8, y0 = window / 4 * 8;
            list.fill(slice, all, {x0, y0, x0 + 8, y0 + 8});
            for (int i = 0; i < 100; ++i) {
                const Vec3 view = camera.ray_direction(
                    {uniform(random, x0, x0 + 8), uniform(random, y0, y0 + 8)});
                const Ray ray =
                    camera.to_world(ViewRay{Vec3::Zero(), view}, scene.settings.max_distance);
                const Hit best = nearest_of_all(placed, ray, scene.settings, stats);
                const Hit hit = list.nearest(placed, view, ray, scene.settings, stats);
                hit_count += best ? 1 : 0;
                ASSERT_EQ(hit.distance, best.distance) << round;
                ASSERT_EQ(hit.body, best.body) << round;
            }
        }
    }
    EXPECT_GT(hit_count, 8000);  // of 38400
}

TEST(FilmList, EqualDistancesGoToTheLowerId) {
    TestScene scene;
    for (int i = 0; i < 20; ++i) scene.add(Hypersphere{1}, {0, 0, 5, 0});
    scene.camera.position = Vec4::Zero();
    scene.camera.look_at = Vec4::UnitZ();
    const Camera camera(scene.camera, 10, 10);
    const PlacedBodies placed = place_bodies(scene.picture(), camera.origin());
    const auto slice = slice_bounds(placed, camera, 200);
    std::vector<std::uint32_t> backwards(20);
    std::iota(backwards.rbegin(), backwards.rend(), 0u);
    FilmList list;
    list.fill(slice, backwards, {4, 4, 6, 6});
    FrameStats stats;
    for (Intersector intersector : {Intersector::kTrace, Intersector::kAnalytic}) {
        scene.settings.intersector = intersector;
        const Hit hit = list.nearest(placed, Vec3::UnitZ(), {Vec4::Zero(), Vec4::UnitZ()},
                                     scene.settings, stats);
        EXPECT_EQ(hit.distance, 4);
        EXPECT_EQ(hit.body, 0u);
    }
}

}  // namespace
}  // namespace tesserae::render
