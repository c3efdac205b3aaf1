// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/dynamics/islands/islands.hpp"
#include "core/dynamics/stepper.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/parallel/first_difference.hpp"

namespace tesserae::parallel {
namespace {

using namespace tesserae::testing;

TEST(MixedHeap, HasTheBitsOfTheSerialWorldAndStaysAboveTheFloor) {
    constexpr int kSteps = 200;
    constexpr double kStep = 1.0 / 240;
    Stepper serial(mixed_heap(), PhysicsSettings{});
    std::uint64_t contacts = 0;
    const Bodies& end = serial.bodies();
    for (int i = 0; i < kSteps; ++i) {
        contacts += serial.step(kStep).contacts;
        for (BodyId id = 0; id < end.size(); ++id) {
            const Shape& shape = end.type_of(id).shape;
            if (!is_bounded(shape)) continue;
            const auto extents = [&](const Mat4& R) {
                return std::visit([&](const auto& s) { return half_extents(s, R); }, shape);
            };
            // Nothing sinks into the floor by more than a twentieth of its least size.
            const double least = 2 * extents(Mat4::Identity()).minCoeff();
            const double lowest = end.position[id][1] - extents(to_matrix(end.rotor[id]))[1];
            ASSERT_GT(lowest, -0.05 * least) << id << " in step " << i;
        }
    }
    EXPECT_GT(contacts, 5000u);
    for (int count : {1, 2, 3}) {
        Threads threads(count);
        ParallelStepper world(mixed_heap(), PhysicsSettings{});
        threads.run([&] {
            for (int i = 0; i < kSteps; ++i) world.step(kStep);
        });
        EXPECT_EQ(difference_of(serial, world), "")
            << count << " threads; " << first_difference(mixed_heap(), {}, kStep, kSteps, threads);
    }
}

void expect_serial_bits(const Bodies& bodies, const PhysicsSettings& settings, int steps,
                        const Stepper& serial, const std::vector<int>& counts = {1, 2, 3}) {
    for (const int count : counts) {
        Threads threads(count);
        ParallelStepper world(bodies, settings);
        threads.run([&] {
            for (int i = 0; i < steps; ++i) world.step(1.0 / 80);
        });
        EXPECT_EQ(difference_of(serial, world), "")
            << count << " threads; "
            << first_difference(bodies, settings, 1.0 / 80, steps, threads);
    }
}

PhysicsSettings substepped() {
    PhysicsSettings settings;
    settings.substeps = 3;
    settings.iterations = 2;
    return settings;
}

TEST(MixedHeap, HasTheBitsOfTheSerialWorldWithSubsteps) {
    Stepper serial(mixed_heap(), substepped());
    for (int i = 0; i < 100; ++i) serial.step(1.0 / 80);
    expect_serial_bits(mixed_heap(), substepped(), 100, serial);
}

/// Boxes, capsules and balls that slide over tiles, several to each internal edge.
void expect_serial_bits_on_internal_edges(int steps) {
    Bodies bodies;
    BodyType tile = box_type(Vec4::Ones());
    tile.fixed_position = tile.fixed_rotation = true;
    bodies.types = {tile, box_type({0.5, 0.3, 0.3, 0.3}), capsule_type(0.15, 0.3),
                    sphere_type(0.15)};
    for (int i = 0; i < 216; ++i)
        add(bodies, 0, {i % 6 + 0.5, -0.5, i / 6 % 6 + 0.5, i / 36 + 0.5});
    for (int i = 0; i < 343; ++i)
        add(bodies, 1 + static_cast<std::uint32_t>(i % 3),
            {0.7 * (i % 7) + 0.9, 0.15, 0.7 * (i / 7 % 7) + 0.9, 0.7 * (i / 49) + 0.9},
            {1.0 - 0.01 * i, 0, 0.5, 0.005 * i});
    Stepper serial(bodies, {});
    for (int i = 0; i < steps; ++i) serial.step(1.0 / 80);
    expect_serial_bits(bodies, {}, steps, serial, {1, 2, 4});
}

TEST(InternalEdges, HaveTheBitsOfTheSerialWorldAtAnyNumberOfThreads) {
    expect_serial_bits_on_internal_edges(40);
}
TEST(InternalEdgesSlow, HaveTheBitsOfTheSerialWorldAtAnyNumberOfThreads) {
    expect_serial_bits_on_internal_edges(80);
}

Bodies with_rolling_friction(Bodies bodies) {
    for (BodyType& type : bodies.types) type.rolling_friction = 0.02;
    return bodies;
}

void expect_serial_bits_of_rolling(const std::vector<int>& counts) {
    PhysicsSettings sleepy;
    sleepy.sleeping = true;
    const Bodies small = with_rolling_friction(mixed_heap());
    Stepper serial(small, sleepy);
    for (int i = 0; i < 80; ++i) serial.step(1.0 / 80);
    expect_serial_bits(small, sleepy, 80, serial, counts);

    Bodies large = with_rolling_friction(mixed_heap(6 * 6 * 6 * 4, 6));
    for (BodyId id = 7; id < large.size(); ++id) large.position[id] *= 0.4;
    Stepper packed(large, substepped());
    for (int i = 0; i < 2; ++i) packed.step(1.0 / 80);
    EXPECT_GT(packed.memory().impulses.size(), kColouredFrom);
    expect_serial_bits(large, substepped(), 2, packed, counts);
}

TEST(RollingFriction, HasTheBitsOfTheSerialWorldInSmallAndLargeIslands) {
    expect_serial_bits_of_rolling({3});
}
TEST(RollingFrictionSlow, HasTheBitsOfTheSerialWorldInSmallAndLargeIslands) {
    expect_serial_bits_of_rolling({1, 2, 4});
}

/// One island, with enough contacts to be coloured.
TEST(LargeIsland, HasTheBitsOfTheSerialWorldAtAnyNumberOfThreads) {
    const Bodies bodies = packed_spheres([](int i) { return sphere_type(0.5, 1 + i % 3, 0.5); });
    Stepper serial(bodies, substepped());
    std::uint64_t contacts = 0;
    for (int i = 0; i < 6; ++i) contacts = serial.step(1.0 / 80).contacts;
    EXPECT_GT(contacts, 2 * kColouredFrom);
    expect_serial_bits(bodies, substepped(), 6, serial, {1, 2, 3, 4, 7, 16});
}

/// Boxes, capsules and spheres that overlap a little, and a large sphere that touches more of them
/// than there are colours: one island of pairs with one to eight points, some of them left over.
void expect_serial_bits_of_all_shapes(const std::vector<int>& counts) {
    Bodies bodies = mixed_heap(6 * 6 * 6 * 4, 6);
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const Shape& shape = bodies.type_of(id).shape;
        if (!is_bounded(shape)) continue;
        bodies.position[id] *= 0.5;  // nearer, and the first loads are gains, of which none is left
    }
    add(bodies, sphere_type(2, 100, 0.5), {0, 1.5, 0, 0});
    PhysicsSettings settings = substepped();
    settings.substeps = 2;
    Stepper serial(bodies, settings);
    for (int i = 0; i < 2; ++i) serial.step(1.0 / 80);
    EXPECT_GT(serial.memory().impulses.size(), 2 * kColouredFrom);
    expect_serial_bits(bodies, settings, 2, serial, counts);
}

TEST(LargeIsland, OfAllShapesHasTheBitsOfTheSerialWorld) {
    expect_serial_bits_of_all_shapes({1, 3});
}
TEST(LargeIslandSlow, OfAllShapesHasTheBitsOfTheSerialWorld) {
    expect_serial_bits_of_all_shapes({1, 2, 3, 4, 7, 16});
}

/// Stacks of two boxes fall asleep, and spheres thrown along w wake some of them.
TEST(SleepingStacks, HaveTheBitsOfTheSerialWorld) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (int i = 0; i < 50; ++i)
        add(bodies, box_type(Vec4::Ones(), 10),
            {1.5 * (i / 2 % 5), 0.5 + i % 2, 1.5 * (i / 10), 0});
    for (int i = 0; i < 3; ++i)
        add(bodies, sphere_type(0.4, 20), {1.5 * i, 8, 1.5 * i, -6}, {0, 0, 0, 5});
    PhysicsSettings settings = substepped();
    settings.sleeping = true;
    Stepper serial(bodies, settings);
    std::uint64_t most = 0, woken = 0;
    for (int i = 0; i < 120; ++i) {
        const std::uint64_t asleep = serial.step(1.0 / 80).asleep;
        most = std::max(most, asleep);
        woken = std::max(woken, most - asleep);
    }
    EXPECT_EQ(most, 50u);
    EXPECT_GE(woken, 6u);
    expect_serial_bits(bodies, settings, 120, serial);
}

}  // namespace
}  // namespace tesserae::parallel
