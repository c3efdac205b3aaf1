// SPDX-License-Identifier: Apache-2.0
#include "parallel/sort_and_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/dynamics/contacts/pairs.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/step.hpp"
#include "parallel/threads.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae::parallel {
namespace {

using namespace tesserae::testing;

constexpr double kSearchStep = 1.0 / 240;

/// Everything that comes before the search for pairs.
StepData prepared(const Simulation& simulation) {
    StepData step;
    begin_step(simulation, step, kSearchStep);
    const Range all{0, simulation.bodies.size()};
    advance_first_half(simulation, step, all);
    integrate_velocities(simulation, step, all);
    update_bounds(simulation, step, all);
    return step;
}

std::vector<BodyPair> list(const PairTable& table) {
    std::vector<BodyPair> pairs;
    table.for_each({0, table.size()}, [&](BodyId a, BodyId b) { pairs.push_back({a, b}); });
    return pairs;
}

/// Compares with testing every two bodies, and with the spheres that touch by their distances.
void check(const Bodies& bodies, SortAndSweep& sort_and_sweep, Threads& threads) {
    const Simulation simulation = make_simulation(bodies, PhysicsSettings{});
    StepData step = prepared(simulation);
    PairTable table;
    threads.run([&] { sort_and_sweep.overlapping_pairs(simulation, step.bounds, table); });
    const std::vector<BodyPair> found = list(table);
    std::vector<BodyPair> in_parts;
    for (std::size_t i = 0; i < table.size(); i += 7)
        table.for_each({i, std::min(i + 7, table.size())}, [&](BodyId a, BodyId b) {
            in_parts.push_back({a, b});
        });
    ASSERT_EQ(in_parts, found);
    std::vector<BodyPair> exact;
    test_all_pairs(simulation, step);
    // What it finds beyond that misses by rounding: 1e-12 of a radius, 1e-13 of the place.
    for (const auto [a, b] : found) {
        if (is_pair(simulation, step, a, b)) exact.push_back({a, b});
        const auto larger = [&](Bounds bounds) {
            bounds.radius += 2e-12 * bounds.radius + 2e-13 * bounds.centre.norm();
            return bounds;
        };
        const bool bounded = simulation.type_of(a).bounded && simulation.type_of(b).bounded;
        ASSERT_TRUE(!bounded || overlap(larger(step.bounds[a]), larger(step.bounds[b])));
    }
    ASSERT_EQ(exact, step.pairs);
    ASSERT_TRUE(std::is_sorted(found.begin(), found.end()));

    for (BodyId a = 0; a < bodies.size(); ++a)
        for (BodyId b = a + 1; b < bodies.size(); ++b) {
            const auto* p = std::get_if<Hypersphere>(&bodies.type_of(a).shape);
            const auto* q = std::get_if<Hypersphere>(&bodies.type_of(b).shape);
            if (!p || !q || (!bodies.is_movable(a) && !bodies.is_movable(b))) continue;
            const double distance = (step.position[a] - step.position[b]).norm();
            if (distance > p->radius + q->radius) continue;
            const BodyPair pair{a, b};
            const BodyType &of_a = bodies.type_of(a), &of_b = bodies.type_of(b);
            const bool collide = (of_a.collides_with >> of_b.group) % 2 == 1 &&
                                 (of_b.collides_with >> of_a.group) % 2 == 1;
            ASSERT_EQ(std::binary_search(step.pairs.begin(), step.pairs.end(), pair), collide)
                << a << " " << b;
            ASSERT_EQ(std::binary_search(found.begin(), found.end(), pair), collide);
        }
}

TEST(SortAndSweep, FindsThePairsThatTestingAllFinds) {
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<> unit(0, 1);
    SortAndSweep sort_and_sweep;
    Threads threads(3);
    for (int round = 0; round < 40; ++round) {
        Bodies bodies;
        const int count = static_cast<int>(engine() % 400);
        const double size = 1 + 20 * unit(engine);
        for (int i = 0; i < count; ++i) {
            if (i % 150 == 40) add(bodies, plane_type(Vec4(1, 2, 3, 4).normalized(), size));
            BodyType type = sphere_type(std::pow(10.0, 2 * unit(engine) - 2));  // 1 cm to 1 m
            type.fixed_position = engine() % 6 == 0;
            type.fixed_rotation = engine() % 2 == 0;
            type.group = static_cast<std::uint8_t>(engine() % 5);
            if (engine() % 3 == 0) type.collides_with = engine();
            Vec4 x;
            for (int k = 0; k < 4; ++k) x[k] = size * unit(engine) * (k == round % 4 ? 1 : 0.3);
            const Vec4 v{100 * unit(engine) * (engine() % 8 == 0), 0, 0, 0};
            add(bodies, type, x, v);
        }
        check(bodies, sort_and_sweep, threads);
    }
}

TEST(SortAndSweep, FindsCoincidentAndTouchingBodies) {
    SortAndSweep sort_and_sweep;
    Threads threads(2);
    Bodies bodies;
    for (int i = 0; i < 40; ++i) add(bodies, sphere_type(0.5), {0, 1, 0, 0});
    for (int i = 0; i < 40; ++i) add(bodies, sphere_type(0.5), {10.0 + i, 0, 0, 0});
    for (int i = 0; i < 40; ++i) add(bodies, sphere_type(0.5), {-10, 0, 0, 10.0 + i});
    check(bodies, sort_and_sweep, threads);
    check(Bodies{}, sort_and_sweep, threads);
}

/// 0.1 + 0.2 is rounded up to their distance, though they miss each other by 1e-17.
TEST(SortAndSweep, FindsBallsThatOverlapByRounding) {
    Bodies bodies;
    for (int i = 0; i < 2; ++i) add(bodies, sphere_type(0.1));
    const Simulation simulation = make_simulation(bodies, PhysicsSettings{});
    SortAndSweep sort_and_sweep;
    Threads threads(1);
    for (int axis = 0; axis < 4; ++axis) {
        const std::vector<Bounds> bounds = {{Vec4::Zero(), 0.1},
                                            {(0.1 + 0.2) * Vec4::Unit(axis), 0.2}};
        ASSERT_TRUE(overlap(bounds[0], bounds[1]));
        PairTable pairs;
        threads.run([&] { sort_and_sweep.overlapping_pairs(simulation, bounds, pairs); });
        EXPECT_EQ(list(pairs), (std::vector<BodyPair>{{0, 1}})) << axis;
    }
}

/// Each body is of another size: sixty powers of two, among which some are rare.
TEST(SortAndSweep, FindsThePairsOfVeryManySizes) {
    std::mt19937_64 engine(5);
    std::uniform_real_distribution<> unit(-1, 1);
    SortAndSweep sort_and_sweep;
    Threads threads(2);
    for (int round = 0; round < 10; ++round) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0));
        for (int i = 0; i < 400; ++i) {
            const double power = 30 * unit(engine);
            const double size =
                std::pow(2.0, round % 2 == 0 ? power : power * std::abs(unit(engine)));
            Vec4 x;
            for (int k = 0; k < 4; ++k) x[k] = 3 * size * unit(engine);
            add(bodies, sphere_type(size), x);
        }
        check(bodies, sort_and_sweep, threads);
    }
}

/// Where neighbouring numbers are up to 1/500 m apart, and farther than the last cell.
TEST(SortAndSweep, FindsThePairsFarFromTheOrigin) {
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<> unit(-1, 1);
    SortAndSweep sort_and_sweep;
    Threads threads(2);
    for (const double far : {1e6, 1e9, 1e13})
        for (int round = 0; round < 8; ++round) {
            Bodies bodies;
            add(bodies, plane_type(Vec4::UnitX(), far));
            for (int i = 0; i < 300; ++i) {
                Vec4 x = (i % 3 == 0 ? -1 : round % 2 + 1) * far * Vec4(1, 0.1, -1, 0.5);
                for (int k = 0; k < 4; ++k) x[k] += 4 * unit(engine);
                add(bodies, sphere_type(0.2 + 0.2 * (i % 5)), x);
            }
            check(bodies, sort_and_sweep, threads);
        }
}

}  // namespace
}  // namespace tesserae::parallel
