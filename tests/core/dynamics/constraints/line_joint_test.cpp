// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/line_joint.hpp"

#include <gtest/gtest.h>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/joint_state.hpp"
#include "core/dynamics/step/step.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

const Vec4 kCentre = Vec4::Zero();

Joint to_world(BodyId id, const JointKind& kind) { return {kWorld, id, kind, false}; }

PhysicsSettings falling() {
    PhysicsSettings settings;
    settings.gravity = kDown;
    return settings;
}

Joint spring(JointKind kind, int coordinate, double stiffness, double damping = 0) {
    Joint joint = to_world(0, kind);
    joint.held = 0;
    joint.drives = {{coordinate, 0, 0, stiffness, damping}};
    return joint;
}

/// A rod about which a body whirls: the pull is m v^2 / r, and the way round a circle.
TEST(LineJoint, PullsWhatWhirlsByTheClosedForm) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        constexpr double kMass = 3, kRadius = 2, kSpeed = 5;
        Bodies bodies;
        const Vec4 out = Vec4(1, 2, -1, 3).normalized(), along = Vec4(3, 0, 0, -1).normalized();
        add(bodies, sphere_type(0.2, kMass), kRadius * out, kSpeed * along);
        Stepper world(make_simulation(bodies, without_gravity(),
                                      {to_world(0, LineJoint{kCentre, kCentre, kRadius})}),
                      coloured_from);
        constexpr int kSteps = 240;
        for (int i = 0; i < kSteps; ++i) {
            world.step(kStep);
            const double pull = world.joint_impulses()[0].impulse.norm() / kStep;
            // The first steps find the circle.
            if (i > 5) {
                EXPECT_NEAR(pull, kMass * kSpeed * kSpeed / kRadius, 0.1) << i;
            }
            EXPECT_NEAR(world.bodies().position[0].norm(), kRadius, 2e-4);
        }
        const double angle = kSpeed / kRadius * kSteps * kStep;
        const Vec4 there = kRadius * (std::cos(angle) * out + std::sin(angle) * along);
        EXPECT_LT((world.bodies().position[0] - there).norm(), 1e-3);
    }
}

/// A rope does nothing until it is taut, and then never lets go further.
TEST(LineJoint, RopesOnlyPull) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        Bodies bodies;
        add(bodies, sphere_type(0.2), {0.3, -0.2, 0.1, 0.2});
        Joint rope = to_world(0, LineJoint{kCentre, kCentre, 2});
        rope.held = 0;
        rope.limits = {{0, -kNoLimit, 0}};
        Stepper world(make_simulation(bodies, falling(), {rope}), coloured_from);
        Bodies free = bodies;
        Stepper alone(free, falling());
        double farthest = 0;
        bool was_taut = false;
        for (int i = 0; i < 2400; ++i) {
            world.step(kStep), alone.step(kStep);
            const double far = world.bodies().position[0].norm();
            farthest = std::max(farthest, far);
            was_taut |= far > 1.999;
            if (!was_taut) {
                EXPECT_EQ(world.bodies().position[0], alone.bodies().position[0]) << i;
                EXPECT_EQ(world.joint_impulses()[0].impulse.norm(), 0) << i;
            }
        }
        EXPECT_TRUE(was_taut);
        EXPECT_LT(farthest, 2.001);
    }
}

/// x'' = -w^2 x: the period to second order in the step, and the energy at any stiffness.
TEST(Spring, SwingsAtItsFrequencyAndKeepsItsEnergy) {
    for (const ColouredFrom& coloured_from : kAllWays)
        for (const double frequency : {0.5, 4.0, 60.0, 5000.0}) {
            constexpr double kMass = 2, kAway = 0.3;
            const double w = 2 * pi * frequency, stiffness = kMass * w * w;
            Bodies bodies;
            add(bodies, sphere_type(0.1, kMass), {0, 1 + kAway, 0, 0});
            // A stiff one swings through the point that it hangs on.
            const bool is_line = frequency < 10;
            Joint joint = is_line ? spring(LineJoint{kCentre, kCentre, 1}, 0, stiffness)
                                  : spring(PointJoint{Vec4::UnitY(), kCentre}, 1, stiffness);
            Stepper world(make_simulation(bodies, without_gravity(), {joint}), coloured_from);
            // The period of the implicit midpoint rule: tan(w' h / 2) = w h / 2.
            const double turn = 2 * std::atan(0.5 * w * kStep);
            const double float_error = coloured_from.held == 1 ? 1e-4 : 1e-9;
            for (int i = 1; i <= 480; ++i) {
                world.step(kStep);
                const double off = world.bodies().position[0][1] - 1;
                EXPECT_NEAR(off, kAway * std::cos(turn * i), float_error * i * (1 + w * kStep))
                    << i;
                const double energy = 0.5 * kMass * world.bodies().velocity[0].squaredNorm() +
                                      0.5 * stiffness * off * off;
                EXPECT_NEAR(energy / (0.5 * stiffness * kAway * kAway), 1, 1e-2);
            }
        }
}

/// x'' = -w^2 x - 2 d w x': under, at and over the critical damping.
TEST(Spring, IsDampedAsTheClosedFormSays) {
    for (const double part : {0.1, 1.0, 3.0}) {
        constexpr double kMass = 2, kAway = 0.3, kSpring = 2 * pi;
        Bodies bodies;
        add(bodies, sphere_type(0.1, kMass), {kAway, 0, 0, 0});
        const double stiffness = kMass * kSpring * kSpring, damping = 2 * part * kSpring * kMass;
        Joint joint = spring(PointJoint{}, 0, stiffness, damping);
        Stepper world(make_simulation(bodies, without_gravity(), {joint}));
        double x = kAway, v = 0;
        for (int i = 0; i < 480; ++i) {
            world.step(kStep);
            for (int k = 0; k < 100; ++k) {  // by small steps of the midpoint
                const double dt = kStep / 100;
                const auto force = [&](double at, double u) {
                    return -kSpring * kSpring * at - 2 * part * kSpring * u;
                };
                const double xm = x + 0.5 * dt * v, vm = v + 0.5 * dt * force(x, v);
                x += dt * vm, v += dt * force(xm, vm);
            }
            EXPECT_NEAR(world.bodies().position[0][0], x, 2e-3 * kAway) << part << " " << i;
        }
    }
}

/// A spring of no length: the way is an ellipse in a plane of four dimensions, and closes.
TEST(Spring, OfNoLengthGoesRoundClosedEllipses) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        constexpr double kMass = 1.5, kSpring = 2 * pi;
        const Vec4 away(1, 0.2, -0.5, 0.3), speed(0.5, -2, 1, 4);
        Bodies bodies;
        add(bodies, sphere_type(0.1, kMass), away, speed);
        Joint joint = to_world(0, PointJoint{});
        joint.held = 0;
        for (int axis = 0; axis < 4; ++axis)
            joint.drives.push_back({axis, 0, 0, kMass * kSpring * kSpring});
        Stepper world(make_simulation(bodies, without_gravity(), {joint}), coloured_from);
        for (int i = 1; i <= 240 * 5; ++i) {
            world.step(kStep);
            const double angle = kSpring * kStep * i;
            const Vec4 there = std::cos(angle) * away + std::sin(angle) / kSpring * speed;
            EXPECT_LT((world.bodies().position[0] - there).norm(), 0.005 * (1 + i * kStep)) << i;
        }
    }
}

/// A stiffness that follows from a frequency is that of both bodies' reduced mass.
TEST(Spring, IsAsStiffAsBothBodiesAsk) {
    Bodies bodies;
    add(bodies, sphere_type(0.1, 2)), add(bodies, sphere_type(0.1, 6), {0, 2, 0, 0});
    EXPECT_NEAR(mass_along({0, 1, LineJoint{kCentre, kCentre, 2}}, 0, bodies), 1.5, 1e-12);
    EXPECT_NEAR(mass_along(to_world(1, LineJoint{kCentre, kCentre, 2}), 0, bodies), 6, 1e-12);
    // Far from a box's centre along x a force along y turns it, too: 1/m + r^2 / I.
    Bodies box;
    add(box, box_type({1, 2, 1, 1}, 3));
    const double inertia = 3 * (1 + 4) / 12.0;
    EXPECT_NEAR(mass_along(to_world(0, PointJoint{Vec4(0.5, 0, 0, 0), Vec4(0.5, 0, 0, 0)}), 1, box),
                1 / (1 / 3.0 + 0.25 / inertia), 1e-12);
}

}  // namespace
}  // namespace tesserae
