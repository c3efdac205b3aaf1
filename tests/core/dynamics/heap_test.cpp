// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

TEST(Heap, OfEightySpheresComesToRestWithSmallOverlaps) {
    const PhysicsSettings settings;
    Stepper world(heap_of_spheres(80, 2), settings);
    const double start = potential_energy(world.bodies(), settings.gravity);
    for (int i = 0; i < 3360; ++i) world.step(kStep);
    double deepest = 0;
    for (int i = 0; i < 240; ++i) deepest = std::max(deepest, world.step(kStep).penetration);
    std::vector<double> speeds;
    for (BodyId id = 7; id < world.bodies().size(); ++id)
        speeds.push_back(world.bodies().velocity[id].norm());
    std::nth_element(speeds.begin(), speeds.begin() + 40, speeds.end());
    RecordProperty("penetration_um", static_cast<int>(1e6 * deepest));
    RecordProperty("median_speed_nm_s", static_cast<int>(1e9 * speeds[40]));
    // The solver leaves 0.005 of the smaller sphere's radius alone, 2.5 mm for the largest two;
    // one part in ten is granted beyond.
    EXPECT_LT(deepest, 1.1 * 0.005 * 0.5);
    // Nothing slows a sphere that rolls along the floor or a wall, so that a few still do after
    // 15 s, which ones is chaos: half of all are slower than 0.1 mm/s, and what is left is less
    // than 1e-4 of what the fall gave (0.1 to 7 J of 3e5 J for starts that differ by 1e-9 m).
    EXPECT_LT(speeds[40], 1e-4);
    const double fallen = start - potential_energy(world.bodies(), settings.gravity);
    EXPECT_LT(kinetic_energy(world.bodies()), 1e-4 * fallen);
}

TEST(Heap, StaysBetweenItsWalls) {
    Stepper world(heap_of_spheres(80, 2), PhysicsSettings{});
    for (int i = 0; i < 600; ++i) world.step(kStep);
    const Bodies& bodies = world.bodies();
    for (BodyId id = 7; id < bodies.size(); ++id) {
        const double radius = std::get<Hypersphere>(bodies.type_of(id).shape).radius;
        const double slack = 2 * 0.005 * radius;
        EXPECT_GT(bodies.position[id][1], radius - slack);
        for (int axis : {0, 2, 3})
            EXPECT_LT(std::abs(bodies.position[id][axis]), 1.2 - radius + slack) << id;
    }
}

TEST(Heap, ContinuesBitForBitFromItsBodiesAndMemory) {
    Stepper world(heap_of_spheres(80, 2), PhysicsSettings{});
    for (int i = 0; i < 300; ++i) world.step(kStep);
    Stepper resumed(world.bodies(), PhysicsSettings{});
    resumed.memory() = world.memory();
    Stepper forgetful(world.bodies(), PhysicsSettings{});
    for (int i = 0; i < 100; ++i) {
        const StepReport expected = world.step(kStep), report = resumed.step(kStep);
        forgetful.step(kStep);
        ASSERT_EQ(report.contacts, expected.contacts);
        ASSERT_EQ(report.penetration, expected.penetration);
    }
    EXPECT_TRUE(same_bits(world.bodies(), resumed.bodies()));
    EXPECT_TRUE(same_values(world.memory(), resumed.memory()));
    EXPECT_FALSE(same_bits(world.bodies(), forgetful.bodies())) << "the memory changes nothing";
}

TEST(Memory, AscendsByPair) {
    Stepper world(heap_of_spheres(80, 2), PhysicsSettings{});
    for (int i = 0; i < 300; ++i) world.step(kStep);
    const auto& impulses = world.memory().impulses;
    ASSERT_GT(impulses.size(), 50u);
    for (std::size_t i = 0; i < impulses.size(); ++i) {
        const KeptImpulse p = impulses[i];
        EXPECT_LT(p.a, p.b);
        EXPECT_GT(p.normal, 0);
        EXPECT_LE(p.tangent().norm(), 0.5 * p.normal * (1 + 1e-6));  // mu = 0.5, in float
        if (i > 0) {
            const KeptImpulse last = impulses[i - 1];
            EXPECT_LT(std::tie(last.a, last.b), std::tie(p.a, p.b));
        }
    }
}

}  // namespace
}  // namespace tesserae
