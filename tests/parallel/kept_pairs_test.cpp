// SPDX-License-Identifier: Apache-2.0
#include "parallel/kept_pairs.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "core/dynamics/contacts/pairs.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/step.hpp"
#include "core/dynamics/stepper.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/parallel/first_difference.hpp"

namespace tesserae::parallel {
namespace {

using namespace tesserae::testing;

constexpr double kSlowStep = 1.0 / 120;

/// Bodies that go their ways, some of which now and then change their velocity, are put elsewhere,
/// fall asleep or wake: the pairs are those that testing all finds, from few searches. Those that
/// are fast leave their balls in every step.
TEST(KeptPairs, AreThoseThatTestingAllFinds) {
    std::mt19937_64 engine(11);
    Threads threads(2);
    for (const auto& [speed, fast] :
         {std::pair{0.0, 0u}, {0.1, 0u}, {3.0, 0u}, {50.0, 0u}, {0.1, 1u}, {0.1, 40u}}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), -1));
        add(bodies, plane_type(Vec4(1, 1, 1, 1) / 2, -2));
        for (int i = 0; i < 300; ++i) {
            BodyType type = sphere_type(0.1 + 0.1 * (i % 8));
            type.fixed_position = type.fixed_rotation = engine() % 5 == 0;
            const bool is_fast = bodies.size() < 2 + fast;
            if (is_fast) type.fixed_position = type.fixed_rotation = false;
            add(bodies, type, random_vector(engine, 2),
                is_fast ? Vec4(100 * random_vector(engine, 1).normalized())
                        : random_vector(engine, speed));
        }
        PhysicsSettings settings;
        settings.sleeping = true;
        Simulation simulation = make_simulation(bodies, settings);
        StepData step;
        KeptPairs kept;
        const Range all{0, bodies.size()};
        constexpr int kSteps = 120;
        std::size_t pairs = 0;
        for (int i = 0; i < kSteps; ++i) {
            begin_step(simulation, step, kSlowStep);
            for (BodyId id = 0; id < bodies.size(); ++id)
                if (engine() % 4 == 0 && simulation.type_of(id).movable) step.asleep[id] = id;
            advance_first_half(simulation, step, all);
            update_bounds(simulation, step, all);
            threads.run([&] { kept.refresh(simulation, step); });
            const std::vector<BodyPair> found = step.pairs;
            test_all_pairs(simulation, step);
            ASSERT_EQ(found, step.pairs) << speed << " m/s, step " << i;
            pairs += found.size();

            Bodies& b = simulation.bodies;
            for (BodyId id = 2; id < b.size(); ++id) b.position[id] += kSlowStep * b.velocity[id];
            const auto chosen = static_cast<BodyId>(2 + fast + engine() % (b.size() - 2 - fast));
            for (BodyId id = 2; id < 2 + fast; ++id)
                if (b.position[id].norm() > 4) b.velocity[id] = -100 * b.position[id].normalized();
            if (i % 10 == 5) b.velocity[chosen] = random_vector(engine, speed);
            if (i % 30 == 20) b.position[chosen] = random_vector(engine, 2);
        }
        EXPECT_GT(pairs, 1000u);
        EXPECT_GT(kept.searches(), 3u);
        // The fastest, of 0.1 m, keeps within its larger ball for no more than a step.
        EXPECT_LT(kept.searches(), speed > 10 ? kSteps + 1u : kSteps / 2u) << speed;
        if (fast > 0) {
            EXPECT_GT(kept.searches_for_some(), kSteps / 2u) << fast;
        }
    }
}

/// The world steps to the serial one's bits, whether or not its pairs are forgotten now and then.
void expect_serial_bits(const Bodies& bodies, const PhysicsSettings& settings, int steps,
                        const std::string& name) {
    Stepper serial(bodies, settings);
    ParallelStepper keeping(bodies, settings), forgetting(bodies, settings);
    Threads threads(2);
    std::mt19937_64 engine(13);
    std::uint64_t contacts = 0;
    for (int i = 0; i < steps; ++i) {
        contacts += serial.step(kSlowStep).contacts;
        threads.run([&] {
            keeping.step(kSlowStep);
            if (engine() % 3 == 0) forgetting.forget_hints();
            forgetting.step(kSlowStep);
        });
        for (const ParallelStepper* world : {&keeping, &forgetting})
            ASSERT_EQ(difference_of(serial, *world), "") << name << ", step " << i;
    }
    EXPECT_GT(contacts, 100u) << name;
}

/// With one sub-step and several, and with and without sleeping.
void expect_serial_bits(const Bodies& bodies, int steps, const std::string& name) {
    for (const bool sleeping : {false, true}) {
        PhysicsSettings settings;
        settings.sleeping = sleeping;
        expect_serial_bits(bodies, settings, steps, name + (sleeping ? ", sleeping" : ""));
        settings = substepped_settings();
        settings.sleeping = sleeping;
        expect_serial_bits(bodies, settings, steps,
                           name + (sleeping ? ", sub-steps, sleeping" : ", sub-steps"));
    }
}

TEST(KeptPairs, ChangeNoBitOfAMixedHeap) { expect_serial_bits(mixed_heap(), 60, "heap"); }
TEST(KeptPairsSlow, ChangeNoBitOfAMixedHeap) { expect_serial_bits(mixed_heap(), 120, "heap"); }

/// Towers that fall asleep, and spheres that come one after the other and wake some.
TEST(KeptPairs, ChangeNoBitWhenBodiesFallAsleepAndWake) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (int i = 0; i < 24; ++i)
        add(bodies, sphere_type(0.5, 1, 0.5), {1.2 * (i / 2 % 4), 0.5 + i % 2, 1.2 * (i / 8), 0});
    for (int i = 0; i < 3; ++i)
        add(bodies, sphere_type(0.4, 20), {1.2 * i, 0.5, 1.2 * i, -6.0 - 4 * i}, {0, 0, 0, 6});
    PhysicsSettings settings;
    settings.sleeping = true;
    Stepper world(bodies, settings);
    std::uint64_t most = 0, woken = 0;
    for (int i = 0; i < 240; ++i) {
        const std::uint64_t asleep = world.step(kSlowStep).asleep;
        most = std::max(most, asleep);
        woken = std::max(woken, most - asleep);
    }
    EXPECT_GT(most, 20u);
    EXPECT_GE(woken, 2u);
    expect_serial_bits(bodies, 240, "towers");
}

/// Small bullets through a heap: in a step they go many times their size.
TEST(KeptPairs, ChangeNoBitOfFastBodies) {
    Bodies bodies = mixed_heap(60);
    for (int i = 0; i < 6; ++i)
        add(bodies, sphere_type(0.05, 5, 0.3), {-5.0 - 20 * i, 0.5 + 0.3 * i, 0.1 * i, 0},
            {100.0 + 100 * i, 0, 0, 0});
    expect_serial_bits(bodies, 60, "bullets");
}

/// A paddle that turns and a slab that moves at velocities of their own.
TEST(KeptPairsSlow, ChangeNoBitOfDrivenBodies) {
    Bodies bodies = mixed_heap(60);
    BodyType slab = box_type({1, 1, 1, 1}), paddle = box_type({2, 0.3, 0.3, 0.5});
    slab.fixed_position = slab.fixed_rotation = true;
    paddle.fixed_position = paddle.fixed_rotation = true;
    add(bodies, slab, {-2, 0.5, 0, 0}, {1.5, 0, 0, 0});
    add(bodies, paddle, {0, 1, 0.5, 0}, Vec4::Zero(), {0, 3, 0, 0, 1, 0});
    expect_serial_bits(bodies, 120, "driven");
}

/// A heap far from the origin, upon a slab a thousand times as large as the grains upon it.
TEST(KeptPairs, ChangeNoBitOfHugeBodiesFarFromTheOrigin) {
    for (const double far : {1e4, 1e8}) {
        Bodies bodies;
        const Vec4 middle(far, -far, 0.5 * far, far);
        BodyType slab = box_type(Vec4::Constant(100));
        slab.fixed_position = slab.fixed_rotation = true;
        add(bodies, slab, middle - 50 * Vec4::UnitY());
        std::mt19937_64 engine(17);
        for (int i = 0; i < 80; ++i) {
            Vec4 x = random_vector(engine, 0.3);
            x[1] = 0.06 + 0.02 * i;
            add(bodies, sphere_type(i % 10 == 0 ? 0.3 : 0.05, 1, 0.5), middle + x);
        }
        expect_serial_bits(bodies, 60, "far");
    }
}

}  // namespace
}  // namespace tesserae::parallel
