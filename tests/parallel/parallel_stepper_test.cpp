// SPDX-License-Identifier: Apache-2.0
#include "parallel/parallel_stepper.hpp"

#include <gtest/gtest.h>

#include "core/dynamics/stepper.hpp"
#include "parallel/threads.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/parallel/first_difference.hpp"

namespace tesserae::parallel {
namespace {

using namespace tesserae::testing;

constexpr double kStep = 1.0 / 240;
constexpr int kSteps = 300;

struct Reference {
    Stepper world{heap_of_spheres(300), PhysicsSettings{}};
    std::uint64_t contacts = 0;

    Reference() {
        for (int i = 0; i < kSteps; ++i) contacts += world.step(kStep).contacts;
    }
};

const Reference& reference() {
    static const Reference once;
    return once;
}

class ParallelWorldOf : public ::testing::TestWithParam<int> {};

TEST_P(ParallelWorldOf, ThreadsHasTheBitsOfTheSerialWorld) {
    const Bodies start = heap_of_spheres(300);
    Threads threads(GetParam());
    ParallelStepper world(start, PhysicsSettings{});
    std::uint64_t contacts = 0;
    threads.run([&] {
        for (int i = 0; i < kSteps; ++i) contacts += world.step(kStep).contacts;
    });
    EXPECT_GT(contacts, 10000u);
    EXPECT_EQ(contacts, reference().contacts);
    EXPECT_EQ(difference_of(reference().world, world), "")
        << first_difference(start, {}, kStep, kSteps, threads);
    EXPECT_FALSE(same_bits(world.bodies(), start));
}

INSTANTIATE_TEST_SUITE_P(Counts, ParallelWorldOf, ::testing::Values(1, 2, 3, 8));

/// Many islands of a few spheres each: messages of several islands, and of one.
Bodies towers() {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (int i = 0; i < 120; ++i) {
        const int height = i % 40 == 0 ? 40 : 1 + i % 4;
        for (int k = 0; k < height; ++k)
            add(bodies, sphere_type(0.5, 1 + k % 3, 0.5),
                {3.0 * (i % 11), 0.5 + 1.001 * k, 3.0 * (i / 11), 0.001 * (k % 2)});
    }
    return bodies;
}

TEST(ParallelStepper, SolvesManyIslandsToTheBitsOfTheSerialWorld) {
    Stepper serial(towers(), PhysicsSettings{});
    for (int i = 0; i < 150; ++i) serial.step(kStep);
    Threads threads(3);
    ParallelStepper world(towers(), PhysicsSettings{});
    threads.run([&] {
        for (int i = 0; i < 150; ++i) world.step(kStep);
    });
    EXPECT_EQ(difference_of(serial, world), "")
        << first_difference(towers(), {}, kStep, 150, threads);
}

TEST(ParallelStepper, ReportsTheBitsOfTheSerialWorld) {
    // Without a fall: every sphere overlaps its neighbours, in several pieces of contacts.
    Bodies bodies = heap_of_spheres(1200, 8);
    for (BodyId id = 7; id < bodies.size(); ++id) bodies.position[id] *= 0.6;
    Stepper serial(bodies, PhysicsSettings{});
    Threads threads(3);
    ParallelStepper world(bodies, PhysicsSettings{});
    threads.run([&] {
        for (int i = 0; i < 3; ++i) {
            const StepReport p = serial.step(kStep), q = world.step(kStep);
            EXPECT_GT(p.contacts, 2 * kReportPiece);
            EXPECT_GT(p.mean_penetration, 0);
            EXPECT_EQ(p.contacts, q.contacts);
            EXPECT_EQ(p.penetration, q.penetration);
            EXPECT_EQ(p.mean_penetration, q.mean_penetration);
            EXPECT_EQ(p.residual, q.residual);
        }
    });
}

TEST(ParallelStepper, ContinuesASerialRun) {
    Stepper serial(towers(), PhysicsSettings{});
    for (int i = 0; i < 40; ++i) serial.step(kStep);
    ParallelStepper world(serial.bodies(), PhysicsSettings{});
    world.memory() = serial.memory();
    Threads threads(2);
    threads.run([&] {
        for (int i = 0; i < 40; ++i) world.step(kStep);
    });
    for (int i = 0; i < 40; ++i) serial.step(kStep);
    EXPECT_EQ(difference_of(serial, world), "");
}

TEST(ParallelStepper, NamesTheLowestBodyThatLeftTheFiniteRange) {
    Bodies bodies = heap_of_spheres(2000);
    for (BodyId id : {1900u, 1000u, 900u}) bodies.velocity[id] = {1e200, 0, 0, 0};
    Threads threads(4);
    ParallelStepper world(bodies, PhysicsSettings{});
    threads.run([&] {
        try {
            world.step(kStep);
            ADD_FAILURE() << "nothing thrown";
        } catch (const LeftFiniteRange& error) {
            EXPECT_EQ(error.body, 900u);
        }
    });
    EXPECT_TRUE(same_bits(world.bodies(), bodies));
}

TEST(ParallelStepper, RefusesWhatTheSerialWorldRefuses) {
    Bodies bodies;
    add(bodies, sphere_type(1));
    bodies.velocity.clear();
    EXPECT_THROW(ParallelStepper(bodies, PhysicsSettings{}), InputError);
    Threads threads(2);
    ParallelStepper empty(Bodies{}, PhysicsSettings{});
    threads.run([&] {
        EXPECT_THROW(empty.step(0), InputError);
        EXPECT_EQ(empty.step(kStep).contacts, 0u);
    });
}

/// Counts the halves of steps in which something was fast.
class FastHalves : public StageObserver {
  public:
    void begin(Stage stage, std::size_t, const Simulation&, const StepData&) override {
        count += stage == Stage::kStopFastBodies;
    }
    void end(Stage) override {}
    int count = 0;
};

/// Bodies of all shapes that shoot through a closed room, some sizes a step.
void expect_serial_bits_at_impacts(const std::vector<int>& counts) {
    Bodies start = mixed_heap();
    std::mt19937_64 random(3);
    for (BodyId id = 0; id < start.size(); ++id) {
        if (!start.is_movable(id)) continue;
        start.types[start.type[id]].restitution = 0.9;
        start.velocity[id] = random_vector(random, 400);
        start.angular_velocity[id] = {50.0 * (id % 7), -40, 30, 100, -20.0 * (id % 3), 10};
    }
    for (const int substeps : {1, 2}) {
        PhysicsSettings settings;
        settings.substeps = substeps;
        Stepper serial(start, settings);
        FastHalves fast;
        serial.observe(&fast);
        for (int i = 0; i < 30; ++i) serial.step(kStep);
        EXPECT_GT(fast.count, 20);
        for (const int count : counts) {
            Threads threads(count);
            ParallelStepper world(start, settings);
            threads.run([&] {
                for (int i = 0; i < 30; ++i) world.step(kStep);
            });
            EXPECT_EQ(difference_of(serial, world), "") << count << " threads";
        }
    }
}

TEST(ParallelStepper, HasTheBitsOfTheSerialWorldWhereBodiesAreStoppedAtImpacts) {
    expect_serial_bits_at_impacts({3});
}
TEST(ParallelWorldSlow, HasTheBitsOfTheSerialWorldWhereBodiesAreStoppedAtImpacts) {
    expect_serial_bits_at_impacts({1, 2, 4});
}

}  // namespace
}  // namespace tesserae::parallel
