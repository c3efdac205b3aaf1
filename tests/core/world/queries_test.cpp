// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <variant>

#include "core/contact/find_contacts.hpp"
#include "core/error.hpp"
#include "core/world/ball_tree.hpp"
#include "tests/core/shape/oracle.hpp"
#include "tests/core/world/random_world.hpp"

// Rays, overlaps and the nearest body, against a search through all bodies.
namespace tesserae {
namespace {

using namespace testing;

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Bodies of all shapes at random, some far larger than others, and two planes.
World crowd(int count, RandomGeometry& random) {
    World world(without_gravity());
    if (count > 20)
        for (const int axis : {1, 3}) world.add(plane_type(Vec4::Unit(axis), -25));
    for (int i = 0; i < count; ++i) {
        BodyType type;
        const double r = random.log_uniform(0.3, 5);
        switch (i % 5) {
            case 0:
                type.shape = Hypersphere{r};
                break;
            case 1:
                type.shape = Hypercapsule{0.3 * r, 3 * r};
                break;
            case 2:
                type.shape = Hyperbox{{r, 0.1 * r, 2 * r, r}};
                break;
            case 3: {
                Duocylinder round;
                round.radii = {r, 0.5 * r};
                type.shape = round;
                break;
            }
            default: {
                Polychoron sharp;
                sharp.radius = r;
                sharp.regular = static_cast<RegularPolychoron>(1 + i % 4);
                type.shape = sharp;
            }
        }
        const Bivector turn{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3),
                            random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
        world.add(type, {random.in_box(Vec4::Constant(15)), exp(turn), Vec4::Zero(), {}});
    }
    return world;
}

/// The signed distance of a point from a body, by its own shape and matrix.
double distance_from(const World& world, BodyId id, const Vec4& point) {
    const BodyState state = world.state(id);
    const Vec4 at = to_matrix(state.rotor).transpose() * (point - state.position);
    return std::visit([&](const auto& s) { return signed_distance(s, at); }, world.type(id).shape);
}

/// Steps along a ray by the distance to the nearest body.
double traced(const World& world, const Vec4& origin, const Vec4& unit, double reach) {
    double t = 0;
    for (int i = 0; i < 10000 && t < reach; ++i) {
        double distance = kNone;
        for (const BodyId id : world.ids())
            distance = std::min(distance, distance_from(world, id, origin + t * unit));
        if (distance < 1e-9) return t;
        t += distance;
    }
    return kNone;
}

TEST(WorldQueries, ARayMeetsWhatSphereTracingMeets) {
    RandomGeometry random(1);
    World world = crowd(120, random);
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec4 origin = random.in_box(Vec4::Constant(20));
        // Some along axes, where a box's sides are parallel to them.
        const Vec4 direction =
            i % 4 == 0 ? Vec4(Vec4::Unit(i / 4 % 4)) : Vec4(3 * random.direction());
        const auto hit = world.ray(origin, direction, 100);
        const double expected = traced(world, origin, direction.normalized(), 100);
        ASSERT_EQ(hit.has_value(), expected < 100) << i;
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(hit->distance, expected, 1e-6) << i;
        if (hit->distance == 0) continue;
        EXPECT_NEAR(distance_from(world, hit->body, hit->point), 0, 1e-12) << i;
        // The distance grows along the normal.
        EXPECT_GT(distance_from(world, hit->body, hit->point + 1e-4 * hit->normal), 0.5e-4) << i;
        EXPECT_FALSE(world.ray(origin, direction, 0.999 * hit->distance)) << i;
    }
    EXPECT_GT(hits, 100);
}

TEST(WorldQueries, TheNearestBodyIsThatOfASearchThroughAll) {
    RandomGeometry random(2);
    for (const int count : {1, 3, 150}) {
        World world = crowd(count, random);
        for (int i = 0; i < 300; ++i) {
            const Vec4 point = random.in_box(Vec4::Constant(40));
            double least = kNone;
            for (const BodyId id : world.ids())
                least = std::min(least, distance_from(world, id, point));
            const auto nearest = world.nearest(point);
            ASSERT_TRUE(nearest);
            EXPECT_NEAR(nearest->distance, least, 1e-12) << i;
            EXPECT_NEAR(distance_from(world, nearest->body, nearest->point), 0, 1e-9) << i;
            EXPECT_EQ(world.nearest(point, std::max(0.0, 0.99 * least)).has_value(), least <= 0)
                << i;
        }
    }
}

TEST(WorldQueries, AnOverlapIsThatOfASearchThroughAll) {
    RandomGeometry random(3);
    World world = crowd(150, random);
    std::size_t found = 0;
    for (int i = 0; i < 300; ++i) {
        const Shape shape = Hyperbox{Vec4::Constant(random.log_uniform(1, 30))};
        const Vec4 at = random.in_box(Vec4::Constant(20));
        const Rotor rotor = exp({random.uniform(-3, 3), 0, random.uniform(-3, 3), 0, 1, 0});
        std::vector<BodyId> expected;
        for (const BodyId id : world.ids()) {
            std::vector<Contact> contacts;
            const BodyState state = world.state(id);
            find_contacts(0, shape, {at, rotor}, 1, world.type(id).shape,
                          {state.position, state.rotor}, 0, contacts);
            if (!contacts.empty()) expected.push_back(id);
        }
        EXPECT_EQ(world.overlapping(shape, at, rotor), expected) << i;
        found += expected.size();
    }
    EXPECT_GT(found, 300u);
}

TEST(WorldQueries, SeeWhatWasMovedAddedAndRemoved) {
    World world(without_gravity());
    EXPECT_FALSE(world.ray(Vec4::Zero(), Vec4::UnitX()));
    EXPECT_FALSE(world.nearest(Vec4::Zero()));
    const BodyId ball = world.add(sphere_type(1), {{5, 0, 0, 0}, {}, {1, 0, 0, 0}, {}});
    EXPECT_NEAR(world.ray(Vec4::Zero(), Vec4::UnitX())->distance, 4, 1e-12);
    EXPECT_FALSE(world.ray(Vec4::Zero(), -Vec4::UnitX()));
    for (int i = 0; i < 240; ++i) world.step();
    EXPECT_NEAR(world.ray(Vec4::Zero(), Vec4::UnitX())->distance, 5, 1e-9);
    world.set_state(ball, {{0, 7, 0, 0}, {}, Vec4::Zero(), {}});
    EXPECT_NEAR(world.nearest(Vec4::Zero())->distance, 6, 1e-12);
    EXPECT_NEAR(world.nearest({0, 7, 0, 0.25})->distance, -0.75, 1e-12);
    EXPECT_EQ(world.ray({0, 7, 0, 0}, Vec4::UnitX())->distance, 0);
    world.remove(ball);
    EXPECT_FALSE(world.nearest(Vec4::Zero()));
    EXPECT_THROW(world.ray(Vec4::Zero(), Vec4::Zero()), InputError);
    EXPECT_THROW(world.ray(Vec4::Zero(), Vec4::UnitX(), -1), InputError);
    EXPECT_THROW(world.overlapping(Hyperplane{}, Vec4::Zero()), InputError);
}

TEST(WorldQueries, OfBodiesInEachOtherTheDeepestIsNearest) {
    World world(without_gravity());
    for (int i = 0; i < 40; ++i)
        world.add(sphere_type(1 + 0.1 * i), {{0.05 * i, 0, 0, 0}, {}, Vec4::Zero(), {}});
    const auto nearest = world.nearest(Vec4::Zero());
    EXPECT_EQ(nearest->body, 39u);
    EXPECT_NEAR(nearest->distance, 0.05 * 39 - 4.9, 1e-12);
}

/// A walk that is ended by the nearest body looks at few of many.
TEST(BallTree, AWalkLooksAtFewBodies) {
    RandomGeometry random(4);
    Bodies bodies;
    bodies.types.push_back(sphere_type(0.1));
    for (int i = 0; i < 20000; ++i) add(bodies, 0, random.in_box(Vec4::Constant(10)));
    const BallTree tree(bodies);
    int looked = 0;
    const Vec4 point = Vec4::Constant(1);
    double least = kNone;
    tree.walk([&](const BallTree::Box& box) { return box.distance(point); }, [&] { return least; },
              [&](BodyId id) {
                  ++looked;
                  least = std::min(least, (bodies.position[id] - point).norm() - 0.1);
              });
    double expected = kNone;
    for (const Vec4& centre : bodies.position)
        expected = std::min(expected, (centre - point).norm() - 0.1);
    EXPECT_EQ(least, expected);
    EXPECT_LT(looked, 400);
}

}  // namespace
}  // namespace tesserae
