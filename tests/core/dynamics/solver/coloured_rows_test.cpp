// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/coloured_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/stage_copy.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"
#include "tests/core/dynamics/solver/random_island.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// Of what is not 0.
struct Sizes {
    double least = std::numeric_limits<double>::infinity(), greatest = 0;

    void add(double x) {
        if (x == 0) return;
        least = std::min(least, std::abs(x)), greatest = std::max(greatest, std::abs(x));
    }
};

/// Boxes that lie straight but for rounding: products with what that leaves in their responses fell
/// below float's normal range, and towers at rest took twice the time.
TEST(ColouredRows, LeavesOutWhatRoundingLeaves) {
    Generator random(5);
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    BodyType box = box_type({0.9, 1, 0.9, 0.8});
    box.friction = 0.5;
    for (int i = 0; i < 6; ++i) {
        const Vec4 velocity = random_vector(random, 1e-3);
        const Bivector turn = 1e-17 * random_bivector(random);
        add(bodies, box, {0, i + 0.5, 0, 0}, velocity, {}, exp(turn));
    }
    const StepData step = solved(bodies, PhysicsSettings{}, kStep, 1);
    ASSERT_FALSE(step.coloured.pair_friction.empty());
    Sizes of_body, along, across;
    for (const BodyInertia& inertia : step.coloured.inertias)
        for (const auto& column : inertia.column)
            for (const float x : column) of_body.add(x);
    for (const PairFriction& pair : step.coloured.pair_friction) {
        for (const Eight& entry : pair.response.across)
            for (const float x : entry.lane) across.add(x);
        for (const auto& row : pair.response.along)
            for (const Eight& entry : row)
                for (const float x : entry.lane) along.add(x);
    }
    for (const Sizes& sizes : {of_body, along, across}) {
        EXPECT_GT(sizes.greatest, 0.01);
        EXPECT_GT(sizes.least, 1e-16 * sizes.greatest);
    }
}

TEST(ColouredRows, MakesRowsOnceForAImpactAndTheLoadAfterIt) {
    for (const auto& [friction, rolling] : {std::pair{0.0, 0.0}, {0.3, 0.0}, {0.7, 0.1}})
        for (const bool spheres_only : {false, true}) {
            Unsolved once = random_island(friction, spheres_only, rolling);
            solve_coloured_impact(once.simulation, once.step, 0, OneThread{});
            ASSERT_EQ(once.step.has_rows[0], 1);
            Unsolved anew = once;
            anew.step.has_rows[0] = 0;
            // Where they are made they take these from the bodies, else from the impact's rows.
            for (InverseInertia& inertia : once.step.coloured.inverse_inertias) inertia = {};
            solve_coloured_island(once.simulation, once.step, 0, OneThread{});
            solve_coloured_island(anew.simulation, anew.step, 0, OneThread{});
            EXPECT_TRUE(same_bits(once.step.velocity, anew.step.velocity));
            EXPECT_TRUE(same_bits(once.step.angular_velocity, anew.step.angular_velocity));
            for (std::size_t i = 0; i < once.step.impulses.size(); ++i)
                ASSERT_EQ(once.step.impulses[i].normal, anew.step.impulses[i].normal);
        }
}

/// One thread that counts the pieces of sweeps which it is given.
struct CountingThread : OneThread {
    int* pieces;

    template <class Work>
    double largest(BatchRange batches, std::size_t points, const Work& work) const {
        ++*pieces;
        return OneThread::largest(batches, points, work);
    }
};

/// The sweeps over the load of a tower of ten boxes, after so many steps and then a push [m/s].
int sweeps_of_tower(int steps, double push) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    BodyType box = box_type({1, 1, 1, 1});
    box.friction = 0.5;
    for (int i = 0; i < 10; ++i) add(bodies, box, {0, i + 0.5, 0, 0});
    Stepper world(bodies, PhysicsSettings{});
    for (int i = 0; i < steps; ++i) world.step(kStep);
    StageCopy before(Stage::kSolveIslands);
    world.observe(&before);
    world.step(kStep);
    StepData& step = before.step;
    step.velocity[5][0] += push;
    int pieces = 0;
    solve_coloured_island(before.simulation, step, 0, CountingThread{{}, &pieces});
    const auto colours = static_cast<int>(step.coloured.first_colour[1]);
    return pieces / (3 * (colours - 1));  // the last colour is done without it
}

TEST(ColouredRows, TakeFewerSweepsOverWhatIsAtRest) {
    EXPECT_LT(sweeps_of_tower(240, 0), kLeastSweeps);
    EXPECT_GE(sweeps_of_tower(240, 0.1), kLeastSweeps);
}

/// The largest difference of the velocities of two worlds [m/s; rad/s].
double difference(const StepData& p, const StepData& q) {
    double largest = 0;
    for (std::size_t i = 0; i < p.velocity.size(); ++i) {
        largest = std::max(largest, (p.velocity[i] - q.velocity[i]).norm());
        largest = std::max(largest, norm(p.angular_velocity[i] - q.angular_velocity[i]));
    }
    return largest;
}

/// Two bodies, of which one may be driven or only turn: the two solvers then do the same in the
/// same order, in float and in double.
struct OnePair {
    BodyType a, b;
    Vec4 b_position;
};

std::vector<OnePair> pairs_of_all_kinds() {
    BodyType fixed_box = box_type({4, 1, 4, 4});
    fixed_box.fixed_position = fixed_box.fixed_rotation = true;
    BodyType turning_box = box_type({2, 1, 2, 2}, 5);
    turning_box.fixed_position = true;
    const BodyType plane = plane_type(Vec4::UnitY(), 0);
    const BodyType box = box_type({1, 1.4, 1.2, 0.8}, 2), cube = box_type(Vec4::Ones(), 2);
    const Vec4 up = Vec4::UnitY();
    return {{plane, sphere_type(0.5, 2), 0.499 * up},
            {sphere_type(0.4, 1), sphere_type(0.5, 3), Vec4(0.5, 0.5, 0.4, 0.36)},
            {fixed_box, sphere_type(0.5, 2), 0.999 * up},
            {plane, box, 0.69 * up},
            {plane, cube, 0.497 * up},
            {plane, capsule_type(0.3, 1, 2), 0.29 * up},
            {fixed_box, box, 1.19 * up},
            {turning_box, box, 1.19 * up + Vec4(0.3, 0, 0.2, 0.1)},
            {cube, box, 1.19 * up + Vec4(0.3, 0, 0.2, 0.1)},
            {box, sphere_type(0.4, 1), 1.09 * up + Vec4(0.3, 0, 0.2, 0.1)},
            {box, capsule_type(0.3, 1, 2), Vec4(0.1, 0.98, 0, 0)}};
}

TEST(ColouredRows, SolvesAPairAsTheOneByOneSolverDoes) {
    Generator random(5);
    std::size_t most_points = 0, hits = 0;
    for (const OnePair& pair : pairs_of_all_kinds())
        for (int round = 0; round < 80; ++round) {
            const bool hit = round >= 40;
            const double friction = round % 4 < 2 ? 0.4 : round % 8 < 4 ? 0 : 100;
            Bodies bodies;
            for (const BodyType& shape : {pair.a, pair.b}) {
                BodyType type = shape;
                type.friction = friction;
                type.rolling_friction = round % 5 < 2 ? 0.05 : 0;
                type.restitution = round % 3 == 0 ? 0.3 : 0;
                const bool second = bodies.size() == 1;
                Vec4 velocity(0, 0, 0, 0);
                Bivector omega;
                if (is_bounded(type.shape)) {
                    velocity = random_vector(random, hit ? 0.3 : 0.03);
                    omega = (hit ? 0.2 : 0.02) * random_bivector(random);
                }
                add(bodies, type, second ? pair.b_position : Vec4(0, 0, 0, 0), velocity, omega);
            }
            // Friction and rolling friction leave 3/4 of each other's speed after an iteration. A
            // coloured impact has half of the iterations. Friction of 100 takes more (measured:
            // 5e-4 m/s left after 300).
            const int load = friction > 1 ? 1000 : 300;
            const PhysicsSettings settings = settings_of(hit ? 200 : load);
            const StepData plain = solved(bodies, settings, kStep, kNoneColoured);
            const StepData coloured = solved(bodies, settings, kStep, 1);
            if (plain.contacts.empty()) continue;
            ASSERT_TRUE(coloured.islands.is_coloured(0));
            most_points = std::max(most_points, plain.contacts.size());
            // Speeds of 1 m/s are rounded by 6e-8. Each of up to eight points hands that on to the
            // others, ten times as large where a corner yields that much more than the centre. A
            // impact at several points ends in float as soon as a sweep changes it by 3e-4 m/s, a
            // thousandth of its speed, of which there may be some ten left. With friction the
            // solution is not one alone (measured: 0.07 m/s).
            hits += std::count_if(coloured.hit.begin(), coloured.hit.end(),
                                  [](double h) { return h > 0; });
            const bool single = plain.contacts.size() == 1;
            // At one point friction and turning take turns until the same (measured: 2e-5).
            // Steps along directions carry roundings on, and to another solution where there are
            // several (measured: 7e-3 m/s): both have ended, which the residual tells. Nor does the
            // coloured one see how much higher one point lies than another.
            const bool carried = !single && friction > 0 && friction <= kMostConjugateFriction;
            // Friction of 100 keeps some from ending, chiefly one by one, point after point, where
            // the coloured one solves a pair's normal impulses first (measured: 0.45 m/s).
            const bool jams = !single && friction > kMostConjugateFriction;
            const double several = jams ? 0.6 : 0.1;
            const double most = !hit            ? (carried ? 1e-2
                                                   : jams  ? 4e-5
                                                           : 3e-5)
                                : friction == 0 ? (single ? 1e-5 : 6e-3)
                                                : (single ? 1e-4 : several);
            if (!hit) {
                // Where bodies slide, friction before the normal impulses and after them, as sweeps
                // go forward and backward, take turns (measured: 8.6e-5).
                const double ended = jams || carried ? 1e-4 : 3e-5;
                // Once in a while a step along a direction leads away from what is solved, where
                // bodies slide, and sweeps come back by half in twenty (measured: 1e-3 after 280,
                // 1e-4 after 400, 1e-5 after 500).
                double residual = coloured.residual[0];
                for (const int more : {100, 200})
                    residual = std::min(
                        residual, solved(bodies, settings_of(load + more), kStep, 1).residual[0]);
                EXPECT_LT(residual, std::max(ended, 3 * plain.residual[0]));
            }
            if (!hit && jams && plain.residual[0] > 1e-5) continue;
            EXPECT_LT(difference(plain, coloured), most)
                << "pair of shapes " << bodies.types[0].shape.index() << " and "
                << bodies.types[1].shape.index() << ", round " << round;
        }
    EXPECT_EQ(most_points, 8u);
    EXPECT_GT(hits, 100u);
}

TEST(ImpactFilter, PassesEveryImpact) {
    const Unsolved world = random_island(0.5, false);
    int impacts = 0, stopped = 0;
    for (std::size_t i = 0; i < world.step.contacts.size(); ++i) {
        const Contact contact = world.step.contacts[i];
        const bool passes =
            ImpactFilter(world.simulation, world.step, contact).passes(contact.point);
        const bool impact = impact_of(world.simulation, world.step, i).fastest > 0;
        EXPECT_TRUE(passes || !impact);
        impacts += impact, stopped += !passes;
    }
    EXPECT_GT(impacts, 100);
    EXPECT_GT(stopped, 100);
}

/// A heap of spheres, boxes and capsules about to touch, far from rest, as one island.
Bodies crowd(double friction, bool boxes = true) {
    Generator random(11);
    Bodies bodies;
    for (int i = 0; i < 81; ++i) {
        BodyType type = sphere_type(0.5, 1.0 + i % 4);
        if (boxes && i % 3 == 1) type = box_type({0.9, 1, 0.95, 0.85}, 2);
        if (i % 3 == 2) type = capsule_type(0.4, 0.2, 3);
        type.friction = friction;
        const Vec4 place(i % 3, i / 3 % 3, i / 9 % 3, i / 27);
        const Vec4 velocity = random_vector(random, 1);
        add(bodies, type, 0.9 * place, velocity, random_bivector(random));
    }
    return bodies;
}

/// Without friction the velocities that satisfy all contacts are unique, whatever the order in
/// which they are solved.
TEST(ColouredRows, ConvergesToTheVelocitiesOfTheOneByOneSolver) {
    const PhysicsSettings settings = settings_of(4000);
    const StepData plain = solved(crowd(0, false), settings, kStep, kNoneColoured);
    const StepData coloured = solved(crowd(0, false), settings, kStep, 1);
    ASSERT_GT(coloured.contacts.size(), 150u);
    const auto left = [](const StepData& step) {
        return *std::max_element(step.residual.begin(), step.residual.end());
    };
    // The iterations have ended, up to rounding of some 1 m/s in double and in float. In float each
    // iteration may shift velocities by half a rounding of 6e-8 the same way: with 24 other seeds
    // they were 4e-10 to 1.2e-8 m/s an iteration apart, at 4000 and at 16000 iterations.
    EXPECT_LT(left(plain), 1e-12);
    EXPECT_LT(left(coloured), 1e-6);
    // A step along a direction carries each on, by up to ten sweeps' worth.
    EXPECT_LT(difference(plain, coloured), 10 * 3e-8 * settings.iterations);
    const StepData early = solved(crowd(0, false), settings_of(5), kStep, 1);
    EXPECT_GT(difference(plain, early), 1e-3);
}

/// Bodies shifted to 10^5 m and made ten times as fast, to 10^3 m/s, by powers of two so that the
/// shift rounds positions alone, by 1e-11 m. From 10^2 m/s on the margins are the same.
TEST(ColouredRows, WorksAsWellFarAwayAndAtHighSpeed) {
    const PhysicsSettings settings = settings_of(10);
    const auto moved = [&](const Vec4& by, const Vec4& drift) {
        Bodies bodies = crowd(0.5);
        for (BodyId id = 0; id < bodies.size(); ++id) {
            bodies.position[id] += by - 0.5 * kStep * drift;
            bodies.velocity[id] += drift;
        }
        StepData step = solved(bodies, settings, kStep, 1);
        for (Vec4& velocity : step.velocity) velocity -= drift;
        return step;
    };
    const StepData here = moved(Vec4::Zero(), {128, 0, 0, 0});
    const StepData there = moved({131072, -65536, 131072, 65536}, {1024, -512, 512, 1024});
    ASSERT_GT(here.contacts.size(), 150u);
    ASSERT_EQ(there.contacts.size(), here.contacts.size());
    // Targets are 1/h times overlaps that are 1e-11 m off: 2.4e-9 m/s. These flip roundings of
    // floats, 6e-8 of 1 m/s, which the iterations hand on. So small a slope is gone along or
    // not, as it is rounded: 4e-5 m/s then, and 1e-6 if nothing ever is.
    EXPECT_LT(difference(here, there), 1e-4);
    EXPECT_GT(std::count_if(here.hit.begin(), here.hit.end(), [](double h) { return h > 0; }), 50);
}

/// Eight spheres on 32 that weigh a thousandth.
TEST(ColouredRows, HoldsHeavyBodiesOnLightOnes) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    add_walls(bodies, {0, 2, 3}, 1.05, 0.5);
    for (int i = 0; i < 40; ++i)
        add(bodies, sphere_type(0.5, i < 32 ? 1 : 1000, 0.5),
            {i % 2 - 0.5, i / 8 + 0.5, i / 2 % 2 - 0.5, i / 4 % 2 - 0.5});
    PhysicsSettings settings = settings_of(30);
    settings.substeps = 8;
    Stepper plain(make_simulation(bodies, settings), kNoneColoured);
    Stepper coloured(make_simulation(bodies, settings), 1);
    double deepest_plain = 0, deepest = 0;
    for (int i = 0; i < 240; ++i) {
        deepest_plain = std::max(deepest_plain, plain.step(kStep).penetration);
        deepest = std::max(deepest, coloured.step(kStep).penetration);
    }
    // The overlap that the solver leaves alone; one part in ten is granted beyond.
    EXPECT_LT(deepest_plain, 1.1 * kSlop * 0.5);
    EXPECT_LT(deepest, 1.1 * kSlop * 0.5);
    for (BodyId id = 39; id < 47; ++id) EXPECT_GT(coloured.bodies().position[id][1], 4);
}

}  // namespace
}  // namespace tesserae
