// SPDX-License-Identifier: Apache-2.0
#include "render/scene/glass_bodies.hpp"

#include <gtest/gtest.h>

#include "tests/render/test_scene.hpp"

namespace tesserae::render {
namespace {

/// Bodies of every size and shape, some of glass, in a cloud where some overlap.
TestScene glass_cloud(Random& random, int count) {
    TestScene scene;
    scene.settings.intersector = Intersector::kAnalytic;
    scene.materials.resize(2);
    scene.materials[1].kind = MaterialKind::kGlass;
    for (int i = 0; i < count; ++i)
        scene.add(random_shape(random, i % kShapeKinds, std::exp(uniform(random, -2, 0.5))),
                  random_vector(random, 4), random_rotor(random), random() % 2);
    scene.add(Hyperplane{Vec4::UnitY(), -3}, Vec4::Zero(), {}, random() % 2);
    return scene;
}

struct Placed {
    TestScene scene;
    Picture picture = scene.picture();
    PlacedBodies placed = place_bodies(picture, Vec4::Zero());
    GlassBodies glass{picture, placed};
    mutable FrameStats stats;

    explicit Placed(TestScene s) : scene(std::move(s)) {}
    Placed(const Placed&) = delete;

    bool is_glass(std::uint32_t b) const {
        return scene.materials[scene.appearance[b].material].kind == MaterialKind::kGlass;
    }
    double distance(std::uint32_t b, const Vec4& p) const {
        return std::visit(
            [&](const auto& s) {
                return signed_distance(s, placed.point_to_body(placed.bodies[b], p));
            },
            *placed.bodies[b].shape);
    }
    /// The last glass body that holds a point, all of them tried.
    std::uint32_t medium_at(const Vec4& p, std::uint32_t except) const {
        for (auto b = static_cast<std::uint32_t>(placed.bodies.size()); b-- > 0;)
            if (b != except && is_glass(b) && distance(b, p) < 0) return b;
        return GlassBodies::kNone;
    }
};

TEST(GlassBodies, ListsLoseNoBody) {
    // Against all bodies, one by one; the exit is where the signed distance, followed along the ray
    // by bisection, turns positive.
    Random random(541);
    int exits = 0, hits = 0, beyond = 0;
    for (int round = 0; round < 20; ++round) {
        const Placed p(glass_cloud(random, 60));
        for (int i = 0; i < 4000; ++i) {
            const Vec4 origin = random_vector(random, 4);
            const Ray ray = {origin, random_direction(random)};
            const std::uint32_t medium = p.medium_at(origin, GlassBodies::kNone);
            if (medium == GlassBodies::kNone) continue;
            const auto event = p.glass.next(medium, ray, p.stats);

            double inside = 0, outside = 1e8;
            const bool leaves = p.distance(medium, ray.at(outside)) > 0;
            for (int k = 0; k < 100 && leaves; ++k) {
                const double middle = 0.5 * (inside + outside);
                (p.distance(medium, ray.at(middle)) > 0 ? outside : inside) = middle;
            }
            double expected = leaves ? inside : kMiss;
            bool is_exit = leaves;
            for (std::uint32_t b = 0; b < p.placed.bodies.size(); ++b) {
                if (b == medium || (p.is_glass(b) && b < medium)) continue;
                const double t = hit_distance(p.placed, b, ray, p.scene.settings, p.stats);
                if (t < expected) expected = t, is_exit = false;
            }
            if (expected == kMiss) {
                EXPECT_FALSE(event.hit);
                continue;
            }
            // A grazing exit spreads the bisection's roundings.
            ASSERT_NEAR(event.hit.distance, expected, 1e-7 * (1 + expected)) << round << " " << i;
            ASSERT_EQ(event.is_exit, is_exit) << round << " " << i;
            (is_exit ? exits : hits) += 1;
            if (!is_exit) continue;
            const Vec4 point = ray.at(event.hit.distance);
            const std::uint32_t next = p.glass.medium_beyond(medium, point);
            EXPECT_EQ(next, p.medium_at(point, medium)) << round << " " << i;
            beyond += next != GlassBodies::kNone;
        }
    }
    EXPECT_GT(exits, 200);
    EXPECT_GT(hits, 200);
    EXPECT_GT(beyond, 20);
}

TEST(GlassBodies, WhatTouchesFromOutsideIsNotInTheGlass) {
    // A box that stands on a floor, whichever has the lower number: the ray down leaves the glass.
    for (const bool floor_first : {true, false}) {
        TestScene scene;
        scene.settings.intersector = Intersector::kAnalytic;
        scene.materials.resize(2);
        scene.materials[1].kind = MaterialKind::kGlass;
        if (floor_first) scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
        const BodyId box = scene.add(Hyperbox{Vec4::Constant(2)}, Vec4::Zero(), {}, 1);
        if (!floor_first) scene.add(Hyperplane{Vec4::UnitY(), -1}, Vec4::Zero());
        const Placed p(scene);
        const auto event = p.glass.next(box, {Vec4::Zero(), -Vec4::UnitY()}, p.stats);
        EXPECT_TRUE(event.is_exit);
        EXPECT_EQ(event.hit.body, box);
        EXPECT_EQ(event.hit.distance, 1);
    }
}

TEST(GlassBodies, AreHiddenInLaterOnesThatHoldAllOfThem) {
    // Against many points of the inner body's surface: support points in random directions, which
    // for a box are all of its corners. Where the farthest of them is near the outer body's
    // surface, a farther one may have been missed, and nothing is asked.
    Random random(543);
    int hidden = 0, seen = 0;
    for (int round = 0; round < 1500; ++round) {
        TestScene scene;
        scene.materials[0].kind = MaterialKind::kGlass;
        const bool is_plane = round % 4 == 3;
        const Rotor turns[] = {random_rotor(random), random_rotor(random)};
        const Vec4 place = random_vector(random, 0.3);
        const Shape inner = random_shape(random, round / 4 % 3, 0.4);
        const Shape outer = is_plane ? Shape(Hyperplane{random_direction(random), 0.7})
                                     : random_shape(random, round % 4, 1.3);
        const bool inner_first = round % 5 != 0;
        if (inner_first) scene.add(inner, place, turns[0]);
        scene.add(outer, Vec4::Zero(), is_plane ? Rotor{} : turns[1]);
        if (!inner_first) scene.add(inner, place, turns[0]);
        const Placed p(scene);
        const std::uint32_t first = inner_first ? 0 : 1;
        const PlacedBody& body = p.placed.bodies[first];
        double farthest = -kMiss;
        for (int i = 0; i < 1000; ++i) {
            const Vec4 along = p.placed.direction_to_body(body, random_direction(random));
            const Vec4 point = std::visit([&](const auto& s) { return support(s, along); }, inner);
            farthest = std::max(
                farthest,
                p.distance(1 - first, body.centre + p.placed.direction_to_world(body, point)));
        }
        if (std::abs(farthest) < 0.05) continue;
        const bool is_hidden = farthest < 0 && inner_first;
        ASSERT_EQ(p.glass.hidden_in(first), is_hidden ? 1u : GlassBodies::kNone)
            << round << " " << farthest;
        ASSERT_EQ(p.glass.hidden_in(1), GlassBodies::kNone) << round;
        (is_hidden ? hidden : seen) += 1;
    }
    EXPECT_GT(hidden, 100);
    EXPECT_GT(seen, 100);
}

TEST(GlassBodies, OneCornerThatSticksOutIsSeen) {
    // A box whose corners are 1 m from its centre, which is moved by 0.1 m toward one of them: that
    // is 1.1 m from the ball's centre, its neighbours sqrt(1 + 0.1^2 + 0.1) = 1.054 m.
    for (unsigned corner = 0; corner < 16; ++corner) {
        Vec4 toward;
        for (int axis = 0; axis < 4; ++axis) toward[axis] = corner >> axis & 1 ? 0.5 : -0.5;
        for (const double radius : {1.08, 1.101}) {
            TestScene scene;
            scene.materials[0].kind = MaterialKind::kGlass;
            scene.add(Hyperbox{Vec4::Ones()}, 0.1 * toward);
            scene.add(Hypersphere{radius}, Vec4::Zero());
            const Placed p(scene);
            EXPECT_EQ(p.glass.hidden_in(0), radius > 1.1 ? 1u : GlassBodies::kNone) << corner;
        }
    }
}

TEST(GlassBodies, OfParallelPlanesTheLowerOneIsHidden) {
    for (const double offset : {-1.0, 0.0, 1.0}) {
        TestScene scene;
        scene.materials[0].kind = MaterialKind::kGlass;
        scene.add(Hyperplane{Vec4::UnitY(), 0}, Vec4::Zero());
        scene.add(Hyperplane{Vec4::UnitY(), offset}, Vec4::Zero());
        scene.add(Hypersphere{0.3}, {0, 0, 0, 1});
        const Placed p(scene);
        EXPECT_EQ(p.glass.hidden_in(0), offset < 0 ? GlassBodies::kNone : 1u) << offset;
        EXPECT_EQ(p.glass.hidden_in(2), GlassBodies::kNone);
    }
}

TEST(GlassBodies, EmptySpaceHasIndexOne) {
    Random random(542);
    const Placed p(glass_cloud(random, 9));
    EXPECT_EQ(p.glass.refractive_index(GlassBodies::kNone), 1);
    for (std::uint32_t b = 0; b < p.placed.bodies.size(); ++b)
        if (p.is_glass(b)) {
            EXPECT_EQ(p.glass.refractive_index(b), 1.5);
        }
}

}  // namespace
}  // namespace tesserae::render
