// SPDX-License-Identifier: Apache-2.0
// Bodies whose position, rotation or both are fixed move at their given velocities: what they do to
// others, and that nothing is done to them.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/momentum.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

BodyType kinematic(BodyType type, double friction = 0, double restitution = 0) {
    type.fixed_position = type.fixed_rotation = true;
    type.friction = friction;
    type.restitution = restitution;
    return type;
}

BodyType with_surface(BodyType type, double friction, double restitution = 0) {
    type.friction = friction;
    type.restitution = restitution;
    return type;
}

/// What a belt that runs along x at 1.99 m/s does to a body that is put on it at rest: friction
/// mu g = 5 m/s^2 speeds it up for v/(mu g) = 0.398 s, in which it moves v^2/(2 mu g) = 0.396 m.
void expect_carried(const BodyType& block, double half_height) {
    constexpr double kSpeed = 1.99, kFriction = 0.5, kPull = 5;
    Bodies bodies;
    add(bodies, kinematic(box_type({40, 1, 4, 4}), kFriction), {0, -0.5, 0, 0}, {kSpeed, 0, 0, 0});
    add(bodies, with_surface(block, kFriction), {0, half_height, 0, 0});
    PhysicsSettings settings;
    settings.iterations = 100;  // so that a box's eight corners agree
    settings.tolerance = 1e-6;
    Stepper world(bodies, settings);
    double time = 0;
    for (int i = 0; i < 240; ++i) {
        world.step(kStep);
        time += kStep;
        const double expected = std::min(kSpeed, kPull * time);
        // The solver's iterations leave a part of an impulse of m g h in 1 of 10^6, or so.
        EXPECT_NEAR(world.bodies().velocity[1][0], expected, 1e-6) << i;
        EXPECT_LT(norm(world.bodies().angular_velocity[1]), 1e-6) << i;
    }
    // In the step in which it reaches the belt's speed the mean velocity is off by up to mu g h/2.
    const double expected = kSpeed * time - kSpeed * kSpeed / (2 * kPull);
    EXPECT_NEAR(world.bodies().position[1][0], expected, 0.5 * kPull * kStep * kStep + 1e-6);
    EXPECT_NEAR(world.bodies().position[1][1], half_height, 1e-6);
    EXPECT_EQ(world.bodies().velocity[0], Vec4(kSpeed, 0, 0, 0));
    EXPECT_NEAR(world.bodies().position[0][0], kSpeed * time, 1e-12);
}

TEST(Conveyor, CarriesASphereThatCannotTurn) {
    BodyType sphere = sphere_type(0.4, 2);
    sphere.fixed_rotation = true;
    expect_carried(sphere, 0.4);
}

TEST(Conveyor, CarriesABoxThatCouldTurn) { expect_carried(box_type({1, 0.2, 1, 1}, 3), 0.1); }

TEST(ClosingWall, PushesAtItsOwnSpeedOrThrowsAtTwiceThat) {
    const double wall_speed = 3;
    const BodyType hit[] = {sphere_type(0.5, 2), capsule_type(0.5, 0), box_type({1, 1, 1, 1}, 7)};
    for (const BodyType& type : hit)
        for (const double restitution : {0.0, 0.5, 1.0}) {
            Bodies bodies;
            const Vec4 v{0, 0, 0, wall_speed};
            add(bodies, kinematic(box_type({9, 9, 9, 0.2}), 0.3), {0, 0, 0, -1.1}, v);
            add(bodies, with_surface(type, 0.3, restitution));
            Stepper world(bodies, without_gravity());
            for (int i = 0; i < 240; ++i) world.step(kStep);
            // The wall is 0.5 m from the body: it hits at 1/6 s.
            const double speed = (1 + restitution) * wall_speed;
            const Bodies& after = world.bodies();
            // The last sweep of the impact changed a normal velocity by so much at most.
            const double left = 10 * kImpactResidual * wall_speed;
            EXPECT_LT((after.velocity[1] - Vec4(0, 0, 0, speed)).norm(), left) << restitution;
            EXPECT_LT(norm(after.angular_velocity[1]), left);
            // The velocity changes in the middle of a step, not at the moment of the hit.
            EXPECT_NEAR(after.position[1][3], speed * 5 / 6, speed * kStep) << restitution;
            EXPECT_EQ(after.velocity[0], v);
        }
}

/// A press comes down on two boxes in a pit, until there is no room for both. Nothing stops it, so
/// that overlap grows, but no impulse is the way out.
TEST(ClosingPress, ThrowsNothing) {
    constexpr double kSpeed = 0.5, kFall = 3.5;  // of the press; by falling 0.6 m [m/s]
    std::mt19937_64 engine(3);
    for (int scene = 0; scene < 4; ++scene) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        add_walls(bodies, {0, 2, 3}, 0.6, 0.5);
        const BodyType box = with_surface(box_type(Vec4::Constant(0.5)), 0.5);
        const auto angle = [&] { return uniform(engine, -1, 1); };
        for (const double y : {0.3, 0.92})
            add(bodies, box, y * Vec4::UnitY(), Vec4::Zero(), {},
                exp(Bivector{angle(), angle(), angle(), angle(), angle(), angle()}));
        add(bodies, kinematic(box_type({3, 0.4, 3, 3}), 0.5), 1.64 * Vec4::UnitY(),
            -kSpeed * Vec4::UnitY());
        Stepper world(bodies, PhysicsSettings{});
        double fastest = 0, deepest = 0;
        for (int i = 0; i < 576; ++i) {
            deepest = std::max(deepest, world.step(kStep).penetration);
            fastest = std::max(fastest, fastest_of(world));
        }
        EXPECT_LT(fastest, kFall + 3 * kSpeed) << scene;
        EXPECT_GT(deepest, 0.2) << scene;  // it has squeezed them
    }
}

TEST(KinematicRotation, IsConstantInTwoPlanesAtOnce) {
    Bodies bodies;
    Bivector two_planes{2, 0, 0, 0, 0, -3}, any{0.3, -1, 2, 0.5, 0.1, -0.7};
    const Rotor start = exp(Bivector{0.2, 0.4, -0.3, 0.6, 0.1, -0.5});
    add(bodies, kinematic(box_type({1, 2, 3, 4})), Vec4::Zero(), {1, 0, 0, 2}, two_planes, start);
    add(bodies, kinematic(capsule_type(0.2, 1)), {50, 0, 0, 0}, Vec4::Zero(), any, start);
    BodyType spinner = box_type({1, 2, 3, 4});
    spinner.fixed_rotation = true;
    add(bodies, spinner, {0, 50, 0, 0}, {0, 0, 0, 1}, any, start);
    Stepper world(bodies, without_gravity());
    constexpr int kSteps = 100'000;
    for (int i = 0; i < kSteps; ++i) world.step(kStep);
    // Two roundings a half-step at 2^-53 each, were they all to add up; and the step itself is
    // rounded, which turns by 417 s x 4 rad/s x 2^-53 less.
    const double tolerance = 4 * kSteps * 1.2e-16;
    for (BodyId id = 0; id < 3; ++id) {
        const Bivector& omega = bodies.angular_velocity[id];
        EXPECT_EQ(world.bodies().angular_velocity[id], omega);
        EXPECT_EQ(world.bodies().velocity[id], bodies.velocity[id]);
        const Mat4 expected = to_matrix(exp(-0.5 * kSteps * kStep * omega) * start);
        EXPECT_LT((to_matrix(world.bodies().rotor[id]) - expected).norm(), tolerance) << id;
    }
}

TEST(Turntable, CarriesWhatLiesOnIt) {
    // The top of a box that turns in its plane: what does not slide goes round with it.
    const double turning = 0.5, radius = 1.5;
    BodyType rider = sphere_type(0.4, 2, 1);
    rider.fixed_rotation = true;
    Bodies bodies;
    Bivector spin;
    spin.xw = turning;
    add(bodies, kinematic(box_type({9, 1, 9, 9}), 1), {0, -0.5, 0, 0}, Vec4::Zero(), spin);
    add(bodies, rider, {radius, 0.4, 0, 0});
    Stepper world(bodies, PhysicsSettings{});
    for (int i = 0; i < 480; ++i) world.step(kStep);
    // Friction (10 m/s^2) takes it up to 0.75 m/s in 0.075 s, far less than the 2 s; the velocity
    // is then that of the table where the body is at the end of the step.
    const Vec4& x = world.bodies().position[1];
    const Vec4& v = world.bodies().velocity[1];
    const Vec4 surface = velocity_at(spin, x);
    EXPECT_LT((v - surface).norm(), 1e-5);
    EXPECT_GT(v.norm(), 0.99 * turning * radius);
    // It lags by half of what the table turns while it slides.
    EXPECT_NEAR(std::atan2(x[3], x[0]), turning * (2 - 0.075 / 2), 0.01);
    // While it slides it moves straight on, out by (0.028 m)^2 / 2r.
    EXPECT_NEAR(std::hypot(x[0], x[3]), radius, 0.0005);
    EXPECT_EQ(world.bodies().angular_velocity[0], spin);
}

/// A plate that turns in a plane across gravity, at a given speed or freely, and bodies on it that
/// go with it.
struct Carousel {
    Bodies bodies;
    Bivector spin;
    double turning;

    Carousel(double speed, bool driven) : turning(speed) {
        spin.xw = speed;
        BodyType plate = with_surface(box_type({6, 0.2, 6, 6}, 1e6), 0.8);
        plate.fixed_position = true;
        plate.fixed_rotation = driven;
        add(bodies, plate, {0, -0.1, 0, 0}, Vec4::Zero(), spin);
    }
    BodyId ride(const BodyType& type, const Vec4& place) {
        return add(bodies, with_surface(type, 0.8), place, velocity_at(spin, place), spin);
    }
    /// After it has turned by an angle [rad].
    Stepper turned(const PhysicsSettings& settings, double angle = 20) const {
        Stepper world(bodies, settings);
        for (int i = 0; i < angle / turning * 240; ++i) world.step(kStep);
        return world;
    }
};

/// They went straight on in every step, and came out by exp(w^2 h t / 2): by 9 % in a turn at 3
/// rad/s, until they slid off.
void expect_kept_where_it_is(double angle) {
    for (const bool driven : {true, false})
        for (const double speed : {1.0, 3.0}) {
            Carousel carousel(speed, driven);
            carousel.ride(box_type({0.3, 0.3, 0.3, 0.3}, 3), {0.8, 0.15, 0, 0});
            for (int i = 0; i < 3; ++i)
                carousel.ride(box_type({0.5, 0.1, 0.4, 0.3}, 1), {-0.5, 0.05 + 0.1 * i, 0, 0});
            const Stepper world = carousel.turned(PhysicsSettings{}, angle);
            for (BodyId id = 1; id < carousel.bodies.size(); ++id) {
                const Vec4 &was = carousel.bodies.position[id], &is = world.bodies().position[id];
                EXPECT_NEAR(std::hypot(is[0], is[3]), std::hypot(was[0], was[3]), 2e-3)
                    << id << " " << speed << " " << driven;
            }
        }
}

TEST(Turntable, KeepsWhatStandsOnItWhereItIs) { expect_kept_where_it_is(7); }
TEST(TurntableSlow, KeepsWhatStandsOnItWhereItIs) { expect_kept_where_it_is(20); }

/// It goes in circles at 1/4 of the table's speed (in three dimensions 2/7: E. Fermi's ball; here
/// I = m R^2 / 3, and I / (I + m R^2) = 1/4), in which it gained speed.
TEST(Turntable, LetsABallRollInCircles) {
    Carousel carousel(2, true);
    const double slow = 0.25 * carousel.turning, radius = 0.1, reach = 0.8;
    BodyType ball = with_surface(sphere_type(radius, 1), 0.8);
    // The ball's centre moves with slow x place; what is left to its turning is such that it rolls.
    const Vec4 place(reach, radius, 0, 0);
    Bivector turns;
    turns.xw = slow;
    const Vec4 velocity = velocity_at(turns, place);
    const Vec4 surface = velocity_at(carousel.spin, place);
    // At -R y its surface moves with v + w.(-R y), where y ^ u takes y to u.
    const Bivector rolling = (1 / radius) * wedge(Vec4::UnitY(), velocity - surface);
    const BodyId id = add(carousel.bodies, ball, place, velocity, rolling);
    const Stepper world = carousel.turned(PhysicsSettings{});
    const Vec4 &x = world.bodies().position[id], &v = world.bodies().velocity[id];
    EXPECT_NEAR(v.norm(), slow * reach, 2e-4 * slow * reach);
    EXPECT_NEAR(std::hypot(x[0], x[3]), reach, 2e-4 * reach);
}

TEST(KinematicBody, IsNotMovedByAHeapOnIt) {
    Bodies bodies;
    const Bivector spin{0.5, 0, 0.2, 0, 0, 0.4};
    add(bodies, kinematic(box_type({6, 1, 6, 6}), 0.5), {0, -0.5, 0, 0}, {0, 0.1, 0, 0.2}, spin);
    add(bodies, kinematic(capsule_type(0.5, 2), 0.5), {0, 1, 0, 0}, {0.1, 0, 0, 0}, -spin);
    add(bodies, kinematic(sphere_type(0.7), 0.5), {0, 1, 1.5, 0}, {0, 0, -0.2, 0}, spin);
    const Bodies moved = bodies;
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<> place(-2, 2);
    for (int i = 0; i < 40; ++i) {
        const Vec4 x{place(engine), 2.5 + 0.2 * i, place(engine), place(engine)};
        const BodyType types[] = {sphere_type(0.4, 1e3), box_type({0.6, 0.7, 0.8, 0.5}, 1e-3),
                                  capsule_type(0.3, 0.5)};
        add(bodies, with_surface(types[i % 3], 0.5, 0.2), x);
    }
    Stepper world(bodies, PhysicsSettings{});
    std::uint64_t contacts = 0;
    for (int i = 0; i < 720; ++i) contacts += world.step(kStep).contacts;
    ASSERT_GT(contacts, 1000u);
    for (BodyId id = 0; id < moved.size(); ++id) {
        EXPECT_EQ(world.bodies().velocity[id], moved.velocity[id]);
        EXPECT_EQ(world.bodies().angular_velocity[id], moved.angular_velocity[id]);
        const Vec4 expected = moved.position[id] + 3 * moved.velocity[id];
        EXPECT_LT((world.bodies().position[id] - expected).norm(), 1e-13);
    }
}

TEST(KinematicBody, PassesThroughOthersOfItsKind) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0));
    add(bodies, kinematic(box_type({1, 1, 1, 1})), {0, 0, 0, 0}, {0, -1, 0, 0}, {1, 0, 0, 0, 0, 2});
    add(bodies, kinematic(sphere_type(1)), {0.5, 0, 0, 0}, {-1, 0, 0, 0});
    add(bodies, kinematic(capsule_type(0.5, 1)), {0, 0, 0.5, 0}, {0, 0, -1, 0}, {0, 3, 0, 0, 0, 0});
    Stepper world(bodies, PhysicsSettings{});
    for (int i = 0; i < 240; ++i) {
        const StepReport report = world.step(kStep);
        EXPECT_EQ(report.contacts, 0u);
        EXPECT_EQ(report.penetration, 0);
    }
    EXPECT_TRUE(world.memory().impulses.empty());
    EXPECT_EQ(world.bodies().velocity, bodies.velocity);
    EXPECT_EQ(world.bodies().angular_velocity, bodies.angular_velocity);
}

TEST(FixedPosition, AlonePinsARodThatTurnsWhenHit) {
    Bodies bodies;
    BodyType rod = with_surface(box_type({4, 0.2, 0.2, 0.2}, 3), 0, 1);
    rod.fixed_position = true;
    add(bodies, rod);
    add(bodies, sphere_type(0.3, 2, 0, 1), {1.5, 1, 0, 0}, {0, -2, 0, 0});
    Stepper world(bodies, without_gravity());
    const double energy = kinetic_energy(bodies);
    const Bivector before = total_angular_momentum(bodies);
    for (int i = 0; i < 240; ++i) world.step(kStep);
    // The pin at the origin has no torque about it. With I = M (4^2 + 0.2^2)/12 and a head-on hit
    // at r = 1.5 m the sphere leaves at v (m r^2 - I)/(m r^2 + I), and omega = (v - v') m r / I.
    const double inertia = 3 * 16.04 / 12, arm = 2 * 1.5 * 1.5;
    const double v = -2 * (arm - inertia) / (arm + inertia);
    const double omega = (-2 - v) * 2 * 1.5 / inertia;
    EXPECT_NEAR(world.bodies().velocity[1][1], v, 1e-12);
    EXPECT_NEAR(world.bodies().angular_velocity[0].xy, omega, 1e-12);
    EXPECT_EQ(world.bodies().position[0], Vec4(Vec4::Zero()));
    EXPECT_EQ(world.bodies().velocity[0], Vec4(Vec4::Zero()));
    // In each of 480 half-steps L goes to the body frame and back, some 10 roundings at 4 J s.
    const double rounding = 480 * 10 * 4 * 1.2e-16;
    EXPECT_LT(norm(total_angular_momentum(world.bodies()) - before), rounding);
    EXPECT_NEAR(kinetic_energy(world.bodies()), energy, rounding);
}

TEST(FixedPosition, MovesAtItsVelocityAndIsFreeToTurn) {
    Bodies bodies;
    BodyType rod = with_surface(box_type({4, 0.2, 0.2, 0.2}, 3), 0, 0);
    rod.fixed_position = true;
    const Vec4 v{0, 2, 0, 0};
    add(bodies, rod, Vec4::Zero(), v);
    add(bodies, sphere_type(0.3, 2), {1.5, 1, 0, 0});
    Stepper world(bodies, without_gravity());
    for (int i = 0; i < 120; ++i) world.step(kStep);
    EXPECT_EQ(world.bodies().velocity[0], v);
    EXPECT_NEAR(world.bodies().position[0][1], 1, 1e-13);
    EXPECT_LT(world.bodies().angular_velocity[0].xy, -0.1) << "its end is held back";
    EXPECT_GT(world.bodies().velocity[1][1], 0.1);
}

TEST(FixedRotation, DrivesLikeAWheelThatTurnsAtAGivenSpeed) {
    // Its surface runs at omega R = 2 m/s: friction mu g = 5 m/s^2 drives it to that speed within
    // 0.4 s and 0.4 m, and its turning does not change.
    Bodies bodies;
    BodyType wheel = sphere_type(0.5, 3, 0.5);
    wheel.fixed_rotation = true;
    Bivector spin;
    spin.xy = -4;
    add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
    add(bodies, wheel, {0, 0.5, 0, 0}, Vec4::Zero(), spin);
    Stepper world(bodies, PhysicsSettings{});
    for (int i = 0; i < 240; ++i) world.step(kStep);
    EXPECT_NEAR(world.bodies().velocity[1][0], 2, 1e-12);
    EXPECT_NEAR(world.bodies().position[1][0], 2 - 0.4, 0.5 * 5 * kStep * kStep + 1e-12);
    EXPECT_EQ(world.bodies().angular_velocity[1], spin);
    const Mat4 turned = to_matrix(world.bodies().rotor[1]);
    EXPECT_LT((turned - to_matrix(exp(-0.5 * spin))).norm(), 1e-12);
}

}  // namespace
}  // namespace tesserae
