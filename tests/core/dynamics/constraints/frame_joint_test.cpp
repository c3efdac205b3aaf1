// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/frame_joint.hpp"

#include <gtest/gtest.h>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/joint_state.hpp"
#include "core/dynamics/diagnostics/momentum.hpp"
#include "core/dynamics/step/step.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

namespace tesserae {
namespace {

using namespace testing;

constexpr std::uint16_t all_but(std::initializer_list<int> free) {
    std::uint16_t held = kAllHeld;
    for (const int coordinate : free) held = static_cast<std::uint16_t>(held & ~(1 << coordinate));
    return held;
}
constexpr int kXY = 4;

/// A joint whose frame has the world's axes at an anchor, as the bodies are placed.
Joint frame_joint(const Bodies& bodies, BodyId a, BodyId b, const Vec4& anchor,
                  std::uint16_t held) {
    const JointedBody of_a = placed(bodies, a), of_b = placed(bodies, b);
    Joint joint{a, b,
                FrameJoint{point_in(of_a, anchor), point_in(of_b, anchor), reverse(of_a.rotor),
                           reverse(of_b.rotor)}};
    joint.held = held;
    return joint;
}

PhysicsSettings falling_settings() {
    PhysicsSettings settings;
    settings.gravity = kDown;
    return settings;
}

double mechanical_energy_of(const Stepper& world) {
    return kinetic_energy(world.bodies()) +
           potential_energy(world.bodies(), world.simulation().settings.gravity);
}

/// Two half boxes, welded, tumble as the whole one does.
TEST(Weld, OfTwoHalvesMovesAsTheWhole) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        const Vec4 velocity(0.5, 1, -0.3, 0.2);
        const Bivector turning{1, -2, 0.5, 1.5, 0.7, -1};
        const Rotor rotor = exp({0.3, -0.4, 0.1, 0.2, 0.5, -0.6});
        Bodies whole, halves;
        add(whole, box_type({2, 0.8, 0.6, 1}, 2), Vec4::Zero(), velocity, turning, rotor);
        for (const double side : {-0.5, 0.5}) {
            const Vec4 r = rotate(rotor, Vec4(side, 0, 0, 0));
            add(halves, box_type({1, 0.8, 0.6, 1}, 1), r, velocity + velocity_at(turning, r),
                turning, rotor);
        }
        Stepper one(whole, falling_settings());
        Stepper two(make_simulation(halves, falling_settings(),
                                    {frame_joint(halves, 0, 1, Vec4::Zero(), kAllHeld)}),
                    coloured_from);
        for (int i = 0; i < 240; ++i) {
            one.step(kStep), two.step(kStep);
            const JointState state =
                state_of(two.simulation().joints.all[0], two.bodies(), two.joint_impulses()[0]);
            EXPECT_LT(state.error, 1e-3) << i;
            EXPECT_LT(state.angular_error, 1e-3) << i;
        }
        const Vec4 middle = 0.5 * (two.bodies().position[0] + two.bodies().position[1]);
        EXPECT_LT((middle - one.bodies().position[0]).norm(), 1e-3);
        const Vec4 side = two.bodies().position[1] - two.bodies().position[0];
        EXPECT_LT((side - rotate(one.bodies().rotor[0], Vec4::UnitX())).norm(), 0.02);
    }
}

/// At rest a welded shelf is where it was put, with the force and the moment of a beam.
TEST(Weld, HoldsAShelf) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        Bodies bodies;
        add(bodies, box_type({1, 0.2, 0.5, 0.5}, 3), {1, 0, 0, 0.4});
        Stepper world(make_simulation(bodies, falling_settings(),
                                      {frame_joint(bodies, kWorld, 0, Vec4::Zero(), kAllHeld)}),
                      coloured_from);
        for (int i = 0; i < 240; ++i) world.step(kStep);
        const Wrench wrench = world.joint_impulses()[0];
        EXPECT_NEAR(wrench.impulse[1], 30 * kStep, 1e-4 * kStep);
        // The weight at (1, 0, 0, 0.4) and the moment of the joint about the anchor cancel.
        const Vec4 anchor =
            rotate(world.bodies().rotor[0], Vec4(-1, 0, 0, -0.4)) + world.bodies().position[0];
        const Bivector moment =
            wrench.moment + wedge(Vec4(anchor - bodies.position[0]), wrench.impulse);
        EXPECT_LT(norm(moment), 1e-3 * kStep);
        EXPECT_LT((world.bodies().position[0] - bodies.position[0]).norm(), 1e-6);
    }
}

/// Along a slope a slider falls with the part of gravity that is left; nothing turns it.
TEST(Slider, FallsAlongItsAxis) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        Bodies bodies;
        const Rotor slope = exp({-0.5 * pi / 6, 0, 0, 0, 0, 0});
        add(bodies, box_type({0.5, 0.3, 0.4, 0.6}, 2), {1, 2, 3, 4});
        Joint joint = frame_joint(bodies, kWorld, 0, bodies.position[0], all_but({0}));
        auto& kind = std::get<FrameJoint>(joint.kind);
        kind.axes_a = kind.axes_a * slope, kind.axes_b = kind.axes_b * slope;
        Stepper world(make_simulation(bodies, falling_settings(), {joint}), coloured_from);
        constexpr int kSteps = 240;
        for (int i = 0; i < kSteps; ++i) world.step(kStep);
        const Vec4 axis = rotate(slope, Vec4::UnitX());
        const Vec4 way = world.bodies().position[0] - bodies.position[0];
        EXPECT_NEAR(way.dot(axis), 0.5 * kDown.dot(axis) * std::pow(kSteps * kStep, 2), 0.03);
        EXPECT_LT((way - way.dot(axis) * axis).norm(), 1e-5);
        EXPECT_LT(norm(log_of_rotation(world.bodies().rotor[0])), 1e-6);
    }
}

/// A wheel that spins many times round stays in its plane, and keeps its energy.
TEST(Hinge, LetsAWheelSpinManyTimesRound) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        Bodies bodies;
        add(bodies, box_type({1, 0.7, 0.3, 0.4}, 2), {0, 0, 0, 0}, Vec4::Zero(),
            {20, 0, 0, 0, 0, 0});
        Stepper world(
            make_simulation(bodies, falling_settings(),
                            {frame_joint(bodies, kWorld, 0, Vec4::Zero(), all_but({kXY}))}),
            coloured_from);
        for (int i = 0; i < 480; ++i) {
            world.step(kStep);
            const JointState state = state_of(world.simulation().joints.all[0], world.bodies(), {});
            EXPECT_LT(state.angular_error, 1e-5) << i;
            EXPECT_LT(state.error, 1e-5) << i;
        }
        EXPECT_NEAR(world.bodies().angular_velocity[0].xy, 20, 1e-3);
        const double angle = std::remainder(20 * 480 * kStep, 2 * pi);
        const JointState end = state_of(world.simulation().joints.all[0], world.bodies(), {});
        EXPECT_NEAR(std::remainder(end.position - angle, 2 * pi), 0, 1e-2);
    }
}

/// Hinged at its end, a box swings as the pendulum of its moment of inertia.
TEST(Hinge, SwingsAsAPendulum) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        constexpr double kMass = 2, kArm = 0.5;
        Bodies bodies;
        add(bodies, box_type({1, 0.2, 0.3, 0.4}, kMass), {kArm, 0, 0, 0});
        Stepper world(
            make_simulation(bodies, falling_settings(),
                            {frame_joint(bodies, kWorld, 0, Vec4::Zero(), all_but({kXY}))}),
            coloured_from);
        const double inertia = kMass * (1 + 0.04) / 12 + kMass * kArm * kArm;
        double angle = 0, speed = 0;
        for (int i = 0; i < 480; ++i) {
            world.step(kStep);
            for (int k = 0; k < 100; ++k) {
                const double dt = kStep / 100;
                angle += 0.5 * dt * speed;
                speed -= dt * kMass * 10 * kArm * std::cos(angle) / inertia;
                angle += 0.5 * dt * speed;
            }
            const JointState state = state_of(world.simulation().joints.all[0], world.bodies(), {});
            EXPECT_NEAR(std::remainder(state.position - angle, 2 * pi), 0, 2e-3) << i;
        }
    }
}

/// A door that falls on its stop stays there, and the stop bears its moment.
TEST(Hinge, StopsAtItsLimits) {
    for (const ColouredFrom& coloured_from : kAllWays)
        for (const double low : {-0.5, -1.2, -2.9}) {
            constexpr double kMass = 2, kArm = 0.5;
            Bodies bodies;
            add(bodies, box_type({1, 0.2, 0.3, 0.4}, kMass), {kArm, 0, 0, 0});
            Joint joint = frame_joint(bodies, kWorld, 0, Vec4::Zero(), all_but({kXY}));
            joint.limits = {{kXY, low, 0.3}};
            Stepper world(make_simulation(bodies, falling_settings(), {joint}), coloured_from);
            double least = 0;
            JointState state;
            for (int i = 0; i < 720; ++i) {
                world.step(kStep);
                state = state_of(world.simulation().joints.all[0], world.bodies(),
                                 world.joint_impulses()[0]);
                least = std::min(least, state.position);
            }
            EXPECT_GT(least, low - 1e-3) << low;
            if (low < -pi / 2) continue;  // it swings
            EXPECT_NEAR(state.position, low, 1e-5) << low;
            EXPECT_NEAR(world.joint_impulses()[0].moment.xy,
                        kMass * 10 * kArm * std::cos(low) * kStep, 1e-3 * kStep)
                << low;
        }
}

/// A swivel keeps its axis, whatever turns in the three planes across it.
TEST(Swivel, KeepsItsAxis) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        Bodies bodies;
        add(bodies, box_type({0.4, 1, 0.3, 0.6}, 2), {0, 0, 0, 0}, Vec4::Zero(),
            {0, 0, 0, 3, -2, 4});
        Stepper world(
            make_simulation(bodies, without_gravity(),
                            {frame_joint(bodies, kWorld, 0, Vec4::Zero(), all_but({7, 8, 9}))}),
            coloured_from);
        const double energy = mechanical_energy_of(world);
        for (int i = 0; i < 960; ++i) {
            world.step(kStep);
            const Vec4 axis = rotate(world.bodies().rotor[0], Vec4::UnitX());
            EXPECT_LT((axis - Vec4::UnitX()).norm(), 1e-4) << i;
        }
        EXPECT_NEAR(mechanical_energy_of(world), energy, 0.02 * energy);
        EXPECT_GT(norm(world.bodies().angular_velocity[0]), 3);
    }
}

/// Momentum stays to rounding, whatever is held, limited or driven between two bodies in flight.
TEST(FrameJoint, KeepsMomentum) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        std::mt19937_64 random(3);
        for (int i = 0; i < 40; ++i) {
            Bodies bodies;
            const Vec4 p = random_vector(random, 2), q = random_vector(random, 2);
            add(bodies, box_type({0.5, 0.6, 0.3, 0.4}, 2), Vec4::Zero(), random_vector(random, 1),
                {p[0], p[1], p[2], p[3], q[0], q[1]});
            add(bodies, box_type({0.4, 0.4, 0.5, 0.3}, 1), {1, 0.3, -0.2, 0.4},
                random_vector(random, 1), {q[2], q[3], p[1], p[0], q[1], p[3]});
            const auto held = static_cast<std::uint16_t>(random() & kAllHeld);
            Joint joint = frame_joint(bodies, 0, 1, {0.5, 0, 0, 0.1}, held);
            for (int k = 0; k < 10; ++k) {
                if ((held >> k & 1) != 0) continue;
                if (k % 3 == 0) joint.limits.push_back({k, -0.3, 0.2});
                if (k % 3 == 1) joint.drives.push_back({k, 0.1, 0, 30, 1});
                if (k % 3 == 2) joint.drives.push_back({k, 0, 2, 0, 0, true, 5});
            }
            Stepper world(make_simulation(bodies, without_gravity(), {joint}), coloured_from);
            const Vec4 momentum = total_momentum(world.bodies());
            const Bivector turning = total_angular_momentum(world.bodies());
            for (int k = 0; k < 120; ++k) world.step(kStep);
            const double rounding = coloured_from.held == 1 ? 1e-4 : 1e-10;
            EXPECT_LT((total_momentum(world.bodies()) - momentum).norm(), rounding) << i;
            EXPECT_LT(norm(total_angular_momentum(world.bodies()) - turning), rounding) << i;
        }
    }
}

/// A motor's moment turns a wheel up to its speed: its work is the wheel's energy.
TEST(Motor, TurnsAWheelUpToItsSpeed) {
    for (const ColouredFrom& coloured_from : kAllWays) {
        constexpr double kMost = 0.8, kSpeed = 6;
        Bodies bodies;
        add(bodies, box_type({1, 1, 0.3, 0.3}, 2), Vec4::Zero());
        Joint joint = frame_joint(bodies, kWorld, 0, Vec4::Zero(), all_but({kXY}));
        joint.drives = {{kXY, 0, kSpeed, 0, 0, true, kMost}};
        Stepper world(make_simulation(bodies, without_gravity(), {joint}), coloured_from);
        const double inertia = 2 * 2 / 12.0, until = kSpeed * inertia / kMost;
        double work = 0;
        for (int i = 1; i <= 960; ++i) {
            const double before = world.bodies().angular_velocity[0].xy;
            world.step(kStep);
            const double now = world.bodies().angular_velocity[0].xy;
            EXPECT_NEAR(now, std::min(kSpeed, kMost * i * kStep / inertia), 1e-4 * kSpeed) << i;
            work += 0.5 * (before + now) * world.joint_impulses()[0].moment.xy;
        }
        ASSERT_LT(until, 960 * kStep);
        EXPECT_NEAR(work, kinetic_energy(world.bodies()), 1e-3 * work);
    }
}

/// Whatever its force: pressed on by gravity or not, and at both ends.
TEST(Motor, StopsAtALimit) {
    for (const double most : {1e4, kNoLimit})
        for (const double speed : {0.8, -0.8})
            for (const ColouredFrom& way : kAllWays) {
                Bodies bodies;
                const Vec4 start{1, 2, 3, 4};
                add(bodies, box_type(Vec4::Constant(0.4), 50), start);
                Joint joint = frame_joint(bodies, kWorld, 0, start, all_but({1}));
                joint.limits = {{1, -0.3, 0.5}};
                joint.drives = {{1, 0, speed, 0, 0, true, most}};
                Stepper world(make_simulation(bodies, PhysicsSettings{}, {joint}), way);
                run(world, 480);
                EXPECT_NEAR(world.bodies().position[0][1], speed > 0 ? 2.5 : 1.7, 1e-4);
                EXPECT_LT(fastest_of(world), 1e-4);
            }
}

/// Two arms in a row, the first driven to an angle: the motor holds both up by its moment.
TEST(Motor, HoldsAnAngleAgainstGravity) {
    Bodies bodies;
    add(bodies, box_type({1, 0.2, 0.3, 0.4}, 2), {0.5, 0, 0, 0});
    add(bodies, box_type({1, 0.2, 0.3, 0.4}, 1), {1.5, 0, 0, 0});
    Joint driven = frame_joint(bodies, kWorld, 0, Vec4::Zero(), all_but({kXY}));
    const double mass = mass_along(driven, kXY, bodies), w = 2 * pi * 10;
    driven.drives = {{kXY, 0, 0, mass * w * w, 2 * mass * w}};
    const Joint welded = frame_joint(bodies, 0, 1, Vec4(1, 0, 0, 0), kAllHeld);
    Stepper world(make_simulation(bodies, falling_settings(), {driven, welded}));
    for (int i = 0; i < 960; ++i) world.step(kStep);
    const double moment = 10 * (2 * 0.5 + 1 * 1.5), sag = moment / (mass * w * w);
    const JointState state = state_of(driven, world.bodies(), world.joint_impulses()[0]);
    EXPECT_NEAR(state.position, -sag, 0.02 * sag);
    EXPECT_NEAR(world.joint_impulses()[0].moment.xy, moment * std::cos(sag) * kStep, 2e-3 * kStep);
}

/// A weld holds a weight just below its force, and lets go just above it; then both collide.
TEST(Joint, BreaksAtItsForce) {
    for (const ColouredFrom& coloured_from : kAllWays)
        for (const double part : {0.99, 1.01}) {
            Bodies bodies;
            add(bodies, sphere_type(0.3, 2), {0, 2, 0, 0});
            Joint joint = frame_joint(bodies, kWorld, 0, bodies.position[0], kAllHeld);
            joint.break_force = 20 / part;
            Stepper world(make_simulation(bodies, falling_settings(), {joint}), coloured_from);
            for (int i = 0; i < 240; ++i) world.step(kStep);
            const bool breaks = part > 1;
            EXPECT_EQ(world.memory().broken, std::vector<std::uint8_t>(breaks ? 1 : 0, 1));
            EXPECT_EQ(world.bodies().position[0][1] < 0, breaks) << part;
        }
}

/// The same of its moment.
TEST(Joint, BreaksAtItsTorque) {
    for (const double part : {0.99, 1.01}) {
        Bodies bodies;
        add(bodies, box_type({1, 0.2, 0.2, 0.2}, 2), {0.5, 2, 0, 0});
        Joint joint = frame_joint(bodies, kWorld, 0, {0, 2, 0, 0}, kAllHeld);
        joint.break_torque = 10 / part;
        Stepper world(make_simulation(bodies, falling_settings(), {joint}));
        for (int i = 0; i < 240; ++i) world.step(kStep);
        EXPECT_EQ(world.memory().broken.empty(), part < 1) << part;
    }
}

/// Which joints are broken is a part of what a step leaves to the next.
TEST(Joint, StaysBrokenInAWorldFromItsMemory) {
    Bodies bodies;
    add(bodies, sphere_type(0.3, 2), {0, 2, 0, 0}),
        add(bodies, sphere_type(0.3, 2), {0, 1.5, 0, 0});
    Joint strong = frame_joint(bodies, kWorld, 0, bodies.position[0], kAllHeld);
    Joint weak = frame_joint(bodies, 0, 1, bodies.position[1], kAllHeld);
    weak.break_force = 19;
    Stepper world(make_simulation(bodies, falling_settings(), {strong, weak}));
    run(world, 10);
    Stepper again(make_simulation(world.bodies(), falling_settings(), {strong, weak}));
    again.memory() = world.memory();
    run(world, 50), run(again, 50);
    EXPECT_EQ(world.memory().broken, (std::vector<std::uint8_t>{0, 1}));
    EXPECT_TRUE(same_bits(world.bodies(), again.bodies()));
    EXPECT_LT(world.bodies().position[1][1], 1.3);
}

}  // namespace
}  // namespace tesserae
