// SPDX-License-Identifier: Apache-2.0
#include "tests/parallel/first_difference.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tesserae::testing {
namespace {

TEST(FirstDifference, NamesTheLowestBodyThatDiffersInABit) {
    const Bodies a = mixed_heap(20);
    EXPECT_EQ(difference_of(a, a), "");
    Bodies b = a;
    b.velocity[17][2] = std::nextafter(1, 2);
    EXPECT_TRUE(difference_of(a, b).starts_with("body 17: velocity (0, 0, 0, 0) and (0, 0, 1.0"));
    b.rotor[9].b.zw += 1e-15;
    EXPECT_TRUE(difference_of(a, b).starts_with("body 9: bivector of the rotor"));
    b.position[9][0] = -a.position[9][0];
    EXPECT_TRUE(difference_of(a, b).starts_with("body 9: position"));
    // A zero of the other sign is another value to memcmp.
    Bodies c = a;
    c.velocity[8][0] = -0.0;
    EXPECT_TRUE(difference_of(a, c).starts_with("body 8: velocity (0, ")) << difference_of(a, c);
}

TEST(FirstDifference, NamesTheFirstContactThatDiffersOrThatOneLacks) {
    Stepper world(mixed_heap(20), PhysicsSettings{});
    for (int i = 0; i < 100; ++i) world.step(1.0 / 240);
    const StepMemory a = world.memory();
    ASSERT_GT(a.impulses.size(), 10u);
    EXPECT_EQ(difference_of(a, a), "");
    StepMemory b = a;
    ContactImpulse impulse = a.impulses[5];
    impulse.normal *= 1 + 1e-15;
    b.impulses.put(5, impulse, a.impulses.feature(5));
    EXPECT_TRUE(difference_of(a, b).starts_with("contact 5: bodies ")) << difference_of(a, b);
    b = a;
    b.impulses = {};
    std::size_t place = 0;
    for (const KeptImpulse& kept : a.impulses)
        if (place++ != 3) b.impulses.push_back(kept);
    EXPECT_TRUE(difference_of(a, b).starts_with("contact 3: bodies ")) << difference_of(a, b);
    b = a;
    b.time += 1;
    EXPECT_EQ(difference_of(a, b), "sleeping bodies or the time");
}

TEST(FirstDifference, FindsTheStep) {
    parallel::Threads threads(2);
    const Bodies bodies = mixed_heap(20);
    EXPECT_EQ(first_difference(bodies, {}, 1.0 / 240, 10, threads),
              "Stepper and ParallelStepper run again do not differ");
}

}  // namespace
}  // namespace tesserae::testing
