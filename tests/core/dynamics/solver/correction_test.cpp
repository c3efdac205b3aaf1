// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/step.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

Bivector random_turning(std::mt19937_64& random, double most) {
    const Vec4 a = random_vector(random, most), b = random_vector(random, most);
    return {a[0], a[1], a[2], b[0], b[1], b[2]};
}

/// A needle, which a turn across its length would make 10^5 times as hard to turn, a plate and a
/// ball.
TEST(PositionCorrection, MovesABodyForHalfAStepAndLeavesItsEnergy) {
    std::mt19937_64 random(1);
    for (const BodyType& type :
         {box_type({1, 1e-3, 1e-3, 1e-3}), box_type({1, 1, 1, 0.01}), sphere_type(0.5)})
        for (int i = 0; i < 100; ++i) {
            Bodies bodies;
            const Vec4 place = random_vector(random, 2), velocity = random_vector(random, 3);
            add(bodies, type, place, velocity, random_turning(random, 100),
                exp(random_turning(random, 2)));
            const Simulation simulation = make_simulation(bodies, PhysicsSettings{});
            StepData step;
            begin_step(simulation, step, kStep);
            step.position = bodies.position, step.rotor = bodies.rotor;
            step.velocity = bodies.velocity, step.angular_velocity = bodies.angular_velocity;
            BodyMotion motion{random_vector(random, 1), random_turning(random, 2)};
            const TypeProperties& properties = simulation.types[0];
            const double half = 0.5 * kStep, half_size = properties.slop / kSlop;
            const double way =
                half * (motion.velocity.norm() + properties.arm * norm(motion.angular_velocity));
            motion = 0.2 * half_size / way * motion;
            displace(simulation, step, 0, motion);
            EXPECT_LT((step.position[0] - place - half * motion.velocity).norm(), 1e-15);
            EXPECT_EQ(step.velocity[0], velocity);
            // A point of the body, turned in many small steps.
            Vec4 arm = rotate(bodies.rotor[0], Vec4(1, 2, 3, 4));
            constexpr int kMany = 1000;
            for (int k = 0; k < kMany; ++k) {
                const Vec4 middle =
                    arm + 0.5 * half / kMany * velocity_at(motion.angular_velocity, arm);
                arm += half / kMany * velocity_at(motion.angular_velocity, middle);
            }
            EXPECT_LT((rotate(step.rotor[0], Vec4(1, 2, 3, 4)) - arm).norm(), 1e-6);
            Bodies moved = bodies;
            moved.rotor = step.rotor, moved.angular_velocity = step.angular_velocity;
            const double before = kinetic_energy(bodies);
            EXPECT_NEAR(kinetic_energy(moved), before, 1e-9 * before);
            // Ten times as fast it does not move ten times as far.
            step.position = bodies.position;
            displace(simulation, step, 0, 10 * motion);
            EXPECT_LT((step.position[0] - place).norm(), 0.25 * half_size * (1 + 1e-9));
        }
}

/// A box starts a tenth of its size deep in the ground: it comes out and hardly rises.
TEST(PositionCorrection, IsInNoVelocity) {
    for (const double rate : {60.0, 240.0, 960.0}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        const BodyType box = box_type(Vec4::Constant(0.5));
        add(bodies, box, 0.2 * Vec4::UnitY());
        Stepper world(bodies, PhysicsSettings{});
        double fastest = 0;
        for (int i = 0; i < 2 * rate; ++i) {
            world.step(1 / rate);
            fastest = std::max(fastest, fastest_of(world));
        }
        const double slop = world.simulation().type_of(1).slop;
        EXPECT_GT(world.bodies().position[1][1], 0.25 - 1.5 * slop) << rate;
        // What a load takes of it, see kCorrectedBias.
        EXPECT_LT(fastest, kBiasPart * kCorrectedBias * slop * rate + 1e-6) << rate;
    }
}

}  // namespace
}  // namespace tesserae
