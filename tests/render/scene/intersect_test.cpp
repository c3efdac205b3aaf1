// SPDX-License-Identifier: Apache-2.0
#include "render/scene/intersect.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// One body about the origin of the camera's frame.
PlacedBodies lone_body(const TestScene& scene) {
    return place_bodies(scene.picture(), Vec4::Zero());
}

struct BothHits {
    double traced, exact;
    FrameStats stats;
};
BothHits hits(const PlacedBodies& placed, const Vec4& origin, const Vec4& direction,
              double limit = 200) {
    Settings settings;
    const Ray ray = {origin, direction, kNoBody, limit};
    BothHits both;
    both.traced = hit_distance(placed, 0, ray, settings, both.stats);
    settings.intersector = Intersector::kAnalytic;
    both.exact = hit_distance(placed, 0, ray, settings, both.stats);
    return both;
}

/// Least signed distance of the body along the ray, by golden section: how nearly the ray grazes.
double clearance(const TestScene& scene, const Vec4& origin, const Vec4& direction) {
    const Mat4 turn = to_matrix(scene.bodies.rotor[0]).transpose();
    const auto f = [&](double t) {
        const Vec4 p = turn * (origin + t * direction - scene.bodies.position[0]);
        return std::visit([&](const auto& s) { return signed_distance(s, p); },
                          scene.bodies.types[0].shape);
    };
    double a = 0, b = 400;
    const double ratio = (std::sqrt(5.0) - 1) / 2;
    for (int i = 0; i < 80; ++i) {
        const double u = b - ratio * (b - a), v = a + ratio * (b - a);
        (f(u) < f(v) ? b : a) = f(u) < f(v) ? v : u;
    }
    return f(a);
}

void expect_trace_as_closed_form(int bodies) {
    Random random(11);
    int hit_count = 0;
    std::uint64_t evaluations = 0, unresolved = 0;
    for (int body = 0; body < bodies; ++body) {
        TestScene scene;
        const double size = std::exp(uniform(random, -3, 2));
        scene.add(random_shape(random, body % kShapeKinds, size), random_vector(random, 5),
                  random_rotor(random));
        const PlacedBodies placed = lone_body(scene);
        for (int i = 0; i < 170; ++i) {
            // Toward a point in or near the body, from around it.
            const Vec4 origin =
                scene.bodies.position[0] + size * uniform(random, 1, 30) * random_direction(random);
            const Vec4 goal = scene.bodies.position[0] + random_vector(random, 1.2 * size);
            const Vec4 direction = (goal - origin).normalized();
            const BothHits h = hits(placed, origin, direction);
            evaluations += h.stats.distance_evaluations;
            unresolved += h.stats.unresolved;
            const bool met = h.exact < kMiss;
            if (met != (h.traced < kMiss)) {
                // Only a ray that grazes to within the tolerance, 1e-13 of the coordinates, may
                // differ; golden section itself is good to 1e-12 of them.
                EXPECT_NEAR(clearance(scene, origin, direction), 0, 1e-11 * (origin.norm() + size))
                    << "body " << body << " ray " << i;
                continue;
            }
            if (!met) continue;
            ++hit_count;
            // Promised: 1e-6 relative, and 1e-3 m at grazing angles. The trace stops 1e-13 of the
            // coordinates above the surface, which at worst (grazing) is
            // sqrt(2 * radius * 1e-13 * coordinates) along the ray, radius <= 5 size.
            const double grazing = std::sqrt(10 * size * 1e-13 * (60 * size + 10));
            EXPECT_NEAR(h.traced, h.exact, 1e-12 * h.exact + grazing)
                << "body " << body << " ray " << i;
            EXPECT_LE(std::abs(h.traced - h.exact), std::min(1e-3, 1e-5 * (h.exact + size)));
        }
    }
    EXPECT_GT(hit_count, 42 * bodies);  // of 170 rays each
    EXPECT_EQ(unresolved, 0u);
    // A sphere needs one evaluation, a capsule or box a few.
    EXPECT_LT(static_cast<double>(evaluations) / (170.0 * bodies), 4);
}

TEST(HitDistance, TraceAgreesWithTheClosedForm) { expect_trace_as_closed_form(1500); }
TEST(HitDistanceSlow, TraceAgreesWithTheClosedForm) { expect_trace_as_closed_form(6000); }

TEST(HitDistance, HyperplaneAgreesWithTheClosedForm) {
    Random random(12);
    for (int i = 0; i < 20000; ++i) {
        TestScene scene;
        Hyperplane plane{random_direction(random), uniform(random, -5, 5)};
        complete(plane);
        scene.add(plane, Vec4::Zero());
        const BothHits h =
            hits(lone_body(scene), random_vector(random, 10), random_direction(random));
        if (h.exact == kMiss) {
            EXPECT_EQ(h.traced, kMiss) << i;
        } else {
            // The tolerance in height, 1e-13 of some 220 m, over the slope, which is at least
            // height / 200 m; the height itself cancels from coordinates of 10 m.
            EXPECT_NEAR(h.traced, h.exact, 1e-9 * (1 + h.exact)) << i;
        }
    }
}

TEST(HitDistance, FarFromTheOriginStaysExact) {
    // Everything is taken relative to the camera, here 1e4 m out: what remains is the rounding of
    // the positions themselves, 2e-12 m.
    Random random(13);
    int hit_count = 0;
    for (int i = 0; i < 3000; ++i) {
        TestScene scene;
        const Vec4 far = random_vector(random, 1e4);
        scene.add(random_shape(random, i % kShapeKinds, 1), far, random_rotor(random));
        const Vec4 origin = far + 8 * random_direction(random);
        const PlacedBodies placed = place_bodies(scene.picture(), origin);
        const Vec4 direction = (far + random_vector(random, 0.2) - origin).normalized();
        const BothHits h = hits(placed, Vec4::Zero(), direction);
        if (h.exact == kMiss) continue;
        ++hit_count;
        EXPECT_NEAR(h.traced, h.exact, 1e-6) << i;
    }
    EXPECT_GT(hit_count, 2500);
}

TEST(HitDistance, HugeAndTinyBodies) {
    for (double size : {1e-6, 1e-3, 1.0, 1e3, 1e6})
        for (int kind = 0; kind < kShapeKinds; ++kind) {
            Random random(14);
            TestScene scene;
            scene.add(random_shape(random, kind, size), Vec4::Zero(), random_rotor(random));
            const PlacedBodies placed = lone_body(scene);
            for (int i = 0; i < 300; ++i) {
                const Vec4 origin = 5 * size * random_direction(random);
                const Vec4 direction = (random_vector(random, 0.2 * size) - origin).normalized();
                const BothHits h = hits(placed, origin, direction, kMiss);
                // A slim polychoron is missed now and then.
                ASSERT_TRUE(h.exact < kMiss || kind == 3);
                if (h.exact == kMiss) continue;
                EXPECT_NEAR(h.traced, h.exact, 1e-6 * size) << size << " " << kind << " " << i;
            }
        }
}

TEST(HitDistance, ZeroFromInside) {
    Random random(15);
    for (int i = 0; i < 300; ++i) {
        TestScene scene;
        scene.add(random_shape(random, i % kShapeKinds, 1), Vec4::Zero(), random_rotor(random));
        const BothHits h =
            hits(lone_body(scene), 0.1 * random_direction(random), random_direction(random));
        EXPECT_EQ(h.traced, 0);
        EXPECT_EQ(h.exact, 0);
    }
}

TEST(HitDistance, BeyondTheLimitIsAMissForBoth) {
    for (int kind = 0; kind < 2; ++kind) {
        TestScene scene;
        if (kind == 0)
            scene.add(Hypersphere{1}, {0, 0, 101, 0});
        else
            scene.add(Hyperplane{-Vec4::UnitZ(), -100}, Vec4::Zero());
        const PlacedBodies placed = lone_body(scene);
        for (double limit : {99.999, 100.001}) {
            const BothHits h = hits(placed, Vec4::Zero(), Vec4::UnitZ(), limit);
            EXPECT_EQ(h.traced<kMiss, limit> 100);
            EXPECT_EQ(h.exact<kMiss, limit> 100);
        }
    }
}

TEST(HitDistance, StepsUsedUpAreCountedHits) {
    TestScene scene;
    scene.add(Hyperbox{Vec4::Constant(2)}, Vec4::Zero());
    const PlacedBodies placed = lone_body(scene);
    Settings settings;
    settings.max_steps = 1;
    FrameStats stats;
    const Ray ray = {Vec4(0.3, 0.4, -10, 0.2), Vec4::UnitZ()};
    const double t = hit_distance(placed, 0, ray, settings, stats);
    EXPECT_EQ(stats.unresolved, 1u);
    EXPECT_EQ(stats.distance_evaluations, 1u);
    // Where it stands: never past the surface.
    EXPECT_LE(t, 9);
    settings.max_steps = 2;
    EXPECT_NEAR(hit_distance(placed, 0, ray, settings, stats), 9, 1e-12);
    EXPECT_EQ(stats.unresolved, 1u);
}

}  // namespace
}  // namespace tesserae::render
