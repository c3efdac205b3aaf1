// SPDX-License-Identifier: Apache-2.0
#include "render/scene/view_scene.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

Hit nearest_of_all(const PlacedBodies& placed, const Camera& camera, const ViewRay& ray,
                   const Settings& settings) {
    FrameStats stats;
    return nearest_of_all(placed, camera.to_world(ray, settings.ray_limit()), settings, stats);
}

/// Rays from a lens of radius `aperture` through the film, within `range` along the fourth axis;
/// now and then along an axis. Returns how many hit.
int compare(TestScene& scene, std::uint64_t seed, const SliceRange& range, double aperture,
            int count) {
    Random random(seed);
    const Camera camera(scene.camera, 100, 100);
    const PlacedBodies placed = place_bodies(scene.picture(), camera.origin());
    int hit_count = 0;
    for (const Intersector intersector : {Intersector::kAnalytic, Intersector::kTrace}) {
        scene.settings.intersector = intersector;
        const ViewScene view(placed, camera, scene.settings, range, 2 * aperture);
        std::vector<ViewRay> rays(static_cast<std::size_t>(count));
        for (ViewRay& ray : rays) {
            ray.origin = Vec3(uniform(random, -1, 1), uniform(random, -1, 1), 0) * aperture;
            ray.fourth = uniform(random, range.low, range.high);
            ray.direction =
                camera.ray_direction({uniform(random, 0, 100), uniform(random, 0, 100)});
            if (random() % 4 == 0) ray.direction[random() % 2] = 0;
            if (random() % 8 == 0) ray.direction = Vec3::UnitZ();
            ray.direction.normalize();
        }
        std::vector<Hit> hits(rays.size());
        FrameStats stats;
        view.nearest(rays, hits, stats);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Hit expected = nearest_of_all(placed, camera, rays[i], scene.settings);
            hit_count += expected ? 1 : 0;
            EXPECT_EQ(hits[i].distance, expected.distance) << "ray " << i;
            EXPECT_EQ(hits[i].body, expected.body) << "ray " << i;
        }
    }
    return hit_count;
}

void expect_views_of_all_bodies(int rays) {
    // A pinhole, a lens, a thick slice, both.
    Random random(31);
    int hit_count = 0;
    for (std::uint64_t round = 0; round < 16; ++round) {
        TestScene scene = cloud(300 + round, 120, 2, 0.1, 0.8);
        if (round % 3 == 0) scene.add(Hyperplane{Vec4::UnitY(), -2}, Vec4::Zero());
        scene.camera = random_camera(random, 6);
        const double aperture = round % 2 == 0 ? 0 : 0.5;
        const SliceRange range = round % 4 < 2 ? SliceRange{0, 0} : SliceRange{-0.3, 0.7};
        hit_count += compare(scene, round, range, aperture, rays);
    }
    EXPECT_GT(hit_count, 12.5 * rays);  // of 32 times as many
}

TEST(ViewScene, FindsWhatTryingAllBodiesFinds) { expect_views_of_all_bodies(1200); }
TEST(ViewSceneSlow, FindsWhatTryingAllBodiesFinds) { expect_views_of_all_bodies(4000); }

TEST(ViewScene, SizesOfAllOrdersAndFarAway) {
    Random random(32);
    int hit_count = 0;
    for (std::uint64_t round = 0; round < 8; ++round) {
        TestScene scene = cloud(400 + round, 150, 2, 1e-5, 1);
        scene.add(Hypersphere{100}, {0, 0, 0, 103});
        scene.camera = random_camera(random, round < 4 ? 6 : 1e5);
        // From afar through a narrow opening.
        scene.camera.field_of_view = round < 4 ? 50 : 0.003;
        scene.settings.max_distance = 1e6;
        hit_count += compare(scene, round, {0, 0}, 0.1, 2000);
    }
    EXPECT_GT(hit_count, 8000);  // of 32000
}

TEST(ViewScene, EqualDistancesGoToTheLowerId) {
    TestScene scene;
    for (int i = 0; i < 50; ++i) scene.add(Hypersphere{1}, {0, 0, 5, 0});
    scene.camera.position = Vec4::Zero();
    scene.camera.look_at = Vec4::UnitZ();
    EXPECT_GT(compare(scene, 1, {0, 0}, 0, 500), 100);
}

TEST(ViewScene, NoBodiesOneBodyOnlyPlanes) {
    for (const int kind : {0, 1, 2}) {
        TestScene scene;
        scene.camera.position = Vec4::Zero();
        scene.camera.look_at = Vec4::UnitZ();
        if (kind == 1) scene.add(Hypersphere{1}, {0, 0, 5, 0});
        if (kind == 2) scene.add(Hyperplane{-Vec4::UnitZ(), -4}, Vec4::Zero());
        const Camera camera(scene.camera, 10, 10);
        const PlacedBodies placed = place_bodies(scene.picture(), Vec4::Zero());
        const ViewScene view(placed, camera, scene.settings, {}, 0);
        const std::vector<ViewRay> rays = {{Vec3::Zero(), Vec3::UnitZ(), 0},
                                           {Vec3::Zero(), -Vec3::UnitZ(), 0}};
        std::vector<Hit> hits(2);
        FrameStats stats;
        view.nearest(rays, hits, stats);
        EXPECT_EQ(hits[0].distance, kind == 0 ? kMiss : 4);
        EXPECT_FALSE(hits[1]);
    }
}

TEST(ViewScene, BuildsInAnArenaOfOneThread) {
    TestScene scene = cloud(5, 500, 2, 0.1, 0.5);
    tbb::task_arena arena(1);
    arena.execute([&] { EXPECT_GT(compare(scene, 2, {0, 0}, 0.1, 500), 100); });
}

}  // namespace
}  // namespace tesserae::render
