// SPDX-License-Identifier: Apache-2.0
// What the engine takes from operator new in a step of bodies that have settled, or slide.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <new>
#include <vector>

#include "core/dynamics/stepper.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/parallel/counted_new.hpp"

namespace tesserae::parallel {
namespace {

using namespace tesserae::testing;

/// One large island, of columns of spheres that touch, beside stacks of two and of five boxes,
/// which are many small ones, solved one by one and coloured.
Bodies resting_bodies(double rolling_friction) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    for (int i = 0; i < 5 * 5 * 5 * 5; ++i)
        add(bodies, sphere_type(0.5, 1, 0.5),
            {i % 5 - 2.0, i / 125 + 0.5, i / 5 % 5 - 2.0, i / 25 % 5 - 2.0});
    for (int i = 0; i < 20; ++i)
        add(bodies, box_type(Vec4::Ones(), 10), {10 + 2.0 * (i / 2), 0.5 + i % 2, 0, 0});
    for (int i = 0; i < 50; ++i)
        add(bodies, box_type(Vec4::Ones(), 10), {10 + 2.0 * (i / 5), 0.5 + i % 5, 2, 0});
    for (BodyType& type : bodies.types) type.rolling_friction = rolling_friction;
    return bodies;
}

/// Allocations of ten steps after so many more: the least of a few tens, as a thread that comes to
/// work late makes its own memory then, once.
template <class AnyWorld>
std::uint64_t allocations_after(AnyWorld& world, int steps) {
    for (int i = 0; i < steps; ++i) world.step(1.0 / 240);
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (int ten = 0; ten < 4 && least > 0; ++ten) {
        const std::uint64_t before = allocations();
        std::uint64_t contacts = 0;
        for (int i = 0; i < 10; ++i) contacts += world.step(1.0 / 240).contacts;
        EXPECT_GT(contacts, 1000u);
        least = std::min(least, allocations() - before);
    }
    return least;
}

TEST(Allocations, AreCounted) {
    const std::uint64_t before = allocations();
    // Called by name: a new expression may be left out.
    void* const plain = ::operator new(8);
    void* const aligned = ::operator new (64, std::align_val_t{32});
    EXPECT_EQ(allocations() - before, 2u);
    ::operator delete(plain);
    ::operator delete (aligned, std::align_val_t{32});
}

TEST(Allocations, AreNoneInASettledStep) {
    for (const bool sleeping : {false, true})
        for (PhysicsSettings settings : {PhysicsSettings{}, substepped_settings()}) {
            settings.sleeping = sleeping;
            const double rolling = settings.substeps > 1 ? 0.01 : 0;
            Stepper serial(resting_bodies(rolling), settings);
            EXPECT_EQ(allocations_after(serial, 60), 0u) << sleeping;
            ParallelStepper world(resting_bodies(rolling), settings);
            Threads threads(2);
            // With sleeping: before and after all have fallen asleep.
            for (const int steps : sleeping ? std::vector{60, 130} : std::vector{60})
                threads.run([&] { EXPECT_EQ(allocations_after(world, steps), 0u) << sleeping; });
        }
}

/// So fast that every manifold is found anew in every step, so slow that it is kept.
TEST(Allocations, AreNoneWhereAllSlides) {
    Bodies bodies;
    BodyType floor = box_type({700, 1, 4, 4});
    floor.fixed_position = floor.fixed_rotation = true;
    add(bodies, floor, {300, -0.5, 0, 0});
    for (int i = 0; i < 200; ++i)
        add(bodies, box_type(Vec4::Ones()), {3.0 * i, 0.5, 0, 0}, {0, 0, 0.3, 0});
    for (BodyType& type : bodies.types) type.friction = 0;
    Stepper serial(bodies, PhysicsSettings{});
    EXPECT_EQ(allocations_after(serial, 60), 0u);
    ParallelStepper world(bodies, PhysicsSettings{});
    Threads threads(2);
    threads.run([&] { EXPECT_EQ(allocations_after(world, 60), 0u); });
}

}  // namespace
}  // namespace tesserae::parallel
