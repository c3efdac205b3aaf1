// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "core/dynamics/constraints/contact_row.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/step.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

/// Of a body of this type, turned at random, with motions as it sees them.
bool turns(const BodyType& type, const Bivector& turning, const Bivector& pushed,
           std::mt19937_64& random) {
    const Vec4 a = random_vector(random, 2), b = random_vector(random, 2);
    const Rotor rotor = exp(Bivector{a[0], a[1], a[2], b[0], b[1], b[2]});
    Bodies bodies;
    add(bodies, type, Vec4::Zero(), Vec4::Zero(), {}, rotor);
    const Simulation simulation = make_simulation(bodies, PhysicsSettings{});
    StepData step;
    begin_step(simulation, step, kStep);
    advance_first_half(simulation, step, {0, 1});
    return turns_correction(simulation, step, 0, rotate(rotor, turning), rotate(rotor, pushed));
}

/// Given back after the needle has turned across its length by the angle t, what rolled it has 1 +
/// k sin(t)^2 times its energy, where k, some 10^6 / 3 here, is how much harder it turns across.
TEST(Push, IsNoneWhereTurningWouldMakeItsReturnAThrow) {
    std::mt19937_64 random(1);
    const BodyType needle = box_type({1, 1e-3, 1e-3, 1e-3});
    const Bivector roll{0, 0, 0, 100, 0, 0}, across{0.5, 0, 0, 0, 0, 0};
    for (int i = 0; i < 100; ++i) {
        EXPECT_TRUE(turns(needle, {10, 0, 0, 0, 0, 0}, roll, random));
        EXPECT_TRUE(turns(needle, {0, 10, 0, 0, 0, 0}, roll, random));
        // By 1e-3, where it has 1.3 times its energy.
        EXPECT_FALSE(turns(needle, {0.5, 0, 0, 0, 0, 0}, roll, random));
        // It rolls fast, but its length stays where it is.
        EXPECT_FALSE(turns(needle, {0, 0, 0, 4000, 0, 0}, roll, random));
        EXPECT_FALSE(turns(needle, {0, 0, 0, 4000, 0, 0}, across, random));
        // In its own plane, or next to nothing.
        EXPECT_FALSE(turns(needle, {10, 0, 0, 0, 0, 0}, across, random));
        EXPECT_FALSE(turns(needle, {0, 0, 10, 0, 0, 0}, {0, 0, 0, 1e-5, 0, 0}, random));
        EXPECT_FALSE(turns(sphere_type(0.5), {100, 0, 0, 0, 0, 0}, roll, random));
        EXPECT_FALSE(turns(box_type(Vec4::Ones()), {100, 0, 0, 0, 0, 0}, roll, random));
    }
}

}  // namespace
}  // namespace tesserae
