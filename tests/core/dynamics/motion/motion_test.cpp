// SPDX-License-Identifier: Apache-2.0
// Gravity that acts in part, and damping, by closed forms.
#include "core/dynamics/motion/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/momentum.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

BodyType scaled_ball(double gravity_scale, double restitution = 0) {
    BodyType type = sphere_type(0.5, 2, 0, restitution);
    type.gravity_scale = gravity_scale;
    return type;
}

BodyType damped(BodyType type, double damping) {
    type.damping = damping;
    return type;
}

PhysicsSettings usual_gravity() {
    PhysicsSettings settings;
    settings.gravity = kDown;
    return settings;
}

/// The sum of a contact's normal impulses, which the world keeps [N s].
double load_of(const Stepper& world) {
    double sum = 0;
    for (const KeptImpulse& impulse : world.memory().impulses) sum += impulse.normal;
    return sum;
}

TEST(Motion, FallsByItsPartOfGravity) {
    for (const double scale : {0.0, 0.25, 1.0, 3.0, -1.0}) {
        Bodies bodies;
        add(bodies, scaled_ball(scale), {1, 2, 3, 4}, {0.5, 0, 0, -1});
        Stepper world(bodies, usual_gravity());
        run(world, 240);
        const Vec4 expected = Vec4{1.5, 2, 3, 3} + 0.5 * scale * kDown;
        EXPECT_LT((world.bodies().position[0] - expected).norm(), 1e-12) << scale;
        const double energy =
            kinetic_energy(world.bodies()) + potential_energy(world.bodies(), kDown);
        EXPECT_NEAR(energy, kinetic_energy(bodies) + potential_energy(bodies, kDown), 1e-10);
    }
}

/// At rest between a floor and a ceiling: on the one or below the other.
TEST(Motion, PressesByItsPartOfGravity) {
    for (const double scale : {0.01, 0.25, 1.0, 7.0, -0.5, -3.0}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0));
        add(bodies, plane_type(-Vec4::UnitY(), -1));
        BodyType box = box_type({1, 0.998, 1, 1}, 2);
        box.gravity_scale = scale;
        add(bodies, box, {0, 0.5 - std::copysign(0.001, scale), 0, 0});
        Stepper world(bodies, usual_gravity());
        run(world, 240);
        EXPECT_LT(fastest_of(world), 1e-9) << scale;
        EXPECT_NEAR(load_of(world), std::abs(scale) * 20 * kStep, 1e-9 * std::abs(scale)) << scale;
    }
}

TEST(Motion, BouncesAsHighAsItFellWhateverItsPartOfGravity) {
    for (const double scale : {0.1, 1.0, 4.0, -1.0}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), -10));
        add(bodies, plane_type(-Vec4::UnitY(), -10));
        add(bodies, scaled_ball(scale, 1), {0, scale > 0 ? -8.5 : 8.5, 0, 0});
        Stepper world(bodies, usual_gravity());
        double highest = 0;
        const double start = bodies.position[2][1];
        for (int i = 0; i < 2400; ++i) {
            world.step(kStep);
            const double rise = (world.bodies().position[2][1] - start) * std::copysign(1, scale);
            highest = std::max(highest, rise);
        }
        EXPECT_LT(highest, 1e-9) << scale;
        const double energy =
            kinetic_energy(world.bodies()) + potential_energy(world.bodies(), kDown);
        EXPECT_NEAR(energy, potential_energy(bodies, kDown), 1e-9 * std::abs(scale)) << scale;
    }
}

/// v' = g - d v from v0: v = g/d + (v0 - g/d) exp(-d t).
TEST(Motion, FallsThroughAViscousMediumInSecondOrder) {
    const Vec4 v0{3, 1, 0, -2};
    for (const double damping : {0.1, 1.0, 8.0}) {
        double last = 0;
        for (const int steps : {60, 120, 240}) {
            Bodies bodies;
            add(bodies, damped(sphere_type(0.5), damping), Vec4::Zero(), v0);
            Stepper world(bodies, usual_gravity());
            for (int i = 0; i < steps; ++i) world.step(1.0 / steps);
            const Vec4 end = kDown / damping;
            const double left = std::exp(-damping);
            const Vec4 v = end + left * (v0 - end);
            const Vec4 x = end + (1 - left) / damping * (v0 - end);
            const double error =
                (world.bodies().velocity[0] - v).norm() + (world.bodies().position[0] - x).norm();
            if (last > 0) {
                EXPECT_NEAR(last / error, 4, 0.1) << damping << " " << steps;
            }
            last = error;
        }
        // Of what the two speeds are apart, both splittings miss (d h)^2 / 12 at most.
        const double speeds = (kDown / damping).norm() + v0.norm();
        EXPECT_LT(last, std::pow(damping / 240, 2) / 6 * speeds);
    }
}

/// Its axes' momenta shrink alike, so that the spin of any body keeps its direction in time: the
/// angular momentum is L exp(-d t).
TEST(Motion, DampedSpinKeepsTheDirectionOfItsAngularMomentum) {
    Bodies bodies;
    add(bodies, damped(box_type({1, 2, 0.5, 0.8}, 3), 0.7), Vec4::Zero(), Vec4::Zero(),
        {1, -2, 3, 0.5, 0.25, -1});
    Stepper world(bodies, without_gravity());
    run(world, 480);
    const Bivector before = total_angular_momentum(bodies);
    const Bivector after = total_angular_momentum(world.bodies());
    EXPECT_LT(norm(after - std::exp(-1.4) * before), 1e-9 * norm(before));
}

/// Damping acts on what moves: what rests weighs what it weighs, and what is fixed moves on.
TEST(Motion, DampingLeavesWhatRestsAndWhatIsFixed) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    add(bodies, damped(box_type(Vec4::Ones(), 2), 20), {0, 0.5, 0, 0});
    BodyType belt = damped(box_type({2, 0.1, 1, 1}), 5);
    belt.fixed_position = belt.fixed_rotation = true;
    add(bodies, belt, {0, 5, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0, 0, 2});
    Stepper world(bodies, usual_gravity());
    run(world, 240);
    EXPECT_LT(world.bodies().velocity[1].norm(), 1e-9);
    EXPECT_NEAR(load_of(world), 20 * kStep, 1e-9);
    EXPECT_EQ(world.bodies().velocity[2], Vec4::UnitX());
    EXPECT_EQ(world.bodies().angular_velocity[2].zw, 2);
    EXPECT_NEAR(world.bodies().position[2][0], 1, 1e-12);
}

/// Held in its place a wheel is damped in its turning, and held in its rotation a sled in its way.
TEST(Motion, DampingActsOnTheFreedomThatIsLeft) {
    BodyType wheel = damped(box_type({1, 1, 0.2, 0.2}), 2), sled = wheel;
    wheel.fixed_position = true;
    sled.fixed_rotation = true;
    Bodies bodies;
    add(bodies, wheel, Vec4::Zero(), {1, 0, 0, 0}, {4, 0, 0, 0, 0, 0});
    add(bodies, sled, {0, 5, 0, 0}, {1, 0, 0, 0}, {4, 0, 0, 0, 0, 0});
    Stepper world(bodies, without_gravity());
    run(world, 240);
    const double left = std::exp(-2.0);
    EXPECT_EQ(world.bodies().velocity[0], Vec4::UnitX());
    EXPECT_NEAR(world.bodies().angular_velocity[0].xy, 4 * left, 1e-12);
    EXPECT_NEAR(world.bodies().velocity[1][0], left, 1e-12);
    EXPECT_EQ(world.bodies().angular_velocity[1].xy, 4);
}

TEST(Motion, CollidesOnlyWithTheGroupsThatBothName) {
    for (const bool a_names : {false, true})
        for (const bool b_names : {false, true}) {
            BodyType a = sphere_type(0.5, 1, 0, 1), b = a;
            a.group = 3, b.group = 63;
            a.collides_with = a_names ? std::uint64_t{1} << 63 : 7;
            b.collides_with = b_names ? 8 : ~std::uint64_t{8};
            Bodies bodies;
            add(bodies, a, {-2, 0, 0, 0}, {2, 0, 0, 0});
            add(bodies, b, {2, 0, 0, 0}, {-2, 0, 0, 0});
            Stepper world(bodies, without_gravity());
            run(world, 480);
            const bool collided = world.bodies().velocity[0][0] < 0;
            EXPECT_EQ(collided, a_names && b_names);
            if (!collided) {
                EXPECT_EQ(world.bodies().velocity[0][0], 2);
            }
        }
}

}  // namespace
}  // namespace tesserae
