// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"
#include "tests/core/dynamics/observed_world.hpp"

// Rolling friction against closed forms. A ball's inertia is m R^2/3 in every plane.
namespace tesserae {
namespace {

using namespace testing;

constexpr double kGravity = 10;  // [m/s^2]

std::array<PhysicsSettings, 2> both_settings() {
    return {PhysicsSettings{}, substepped_settings()};
}

/// A unit vector of the floor's three directions.
Vec4 along_floor(std::mt19937_64& random) {
    Vec4 t = random_vector(random, 1);
    t[1] = 0;
    return t.normalized();
}

BodyType rolling_type(BodyType type, double rolling_friction, double friction = 0.5) {
    type.rolling_friction = rolling_friction;
    type.friction = friction;
    return type;
}

/// A ball that rolls without slipping on a floor y = 0, at a speed along t.
struct Ball {
    double radius, mass, rolling_friction, speed;
    Vec4 t;
    double deceleration() const { return 0.75 * kGravity * rolling_friction / radius; }
};

Ball random_ball(std::mt19937_64& random) {
    Ball ball;
    ball.radius = std::exp(uniform(random, -2, 1));
    ball.mass = std::exp(uniform(random, -3, 5));
    ball.rolling_friction = ball.radius * uniform(random, 0.001, 0.2);
    ball.speed = uniform(random, 0.5, 5);
    ball.t = along_floor(random);
    return ball;
}

/// Above the point of the floor, which may be higher than y = 0.
BodyId add_ball(Bodies& bodies, const Ball& ball, const Vec4& floor = Vec4::Zero()) {
    // What is at the bottom, -R y, stands still: v + omega . (-R y) = 0.
    const Bivector omega = (ball.speed / ball.radius) * wedge(Vec4::UnitY(), ball.t);
    return add(bodies, rolling_type(sphere_type(ball.radius, ball.mass), ball.rolling_friction),
               floor + ball.radius * Vec4::UnitY(), ball.speed * ball.t, omega);
}

/// The speed and spin of a ball after a time, in units of its first speed.
void expect_slowed(const Ball& ball, const Bodies& now, BodyId id, double time, double most) {
    const double speed = std::max(0.0, ball.speed - ball.deceleration() * time);
    EXPECT_LT((now.velocity[id] - speed * ball.t).norm(), most * ball.speed)
        << "radius " << ball.radius << " mass " << ball.mass << " rolling friction "
        << ball.rolling_friction << " speed " << ball.speed << " after " << time << " s";
    const Bivector omega = (speed / ball.radius) * wedge(Vec4::UnitY(), ball.t);
    EXPECT_LT(ball.radius * norm(now.angular_velocity[id] - omega), most * ball.speed);
}

TEST(RollingFriction, SlowsABallByThreeQuartersOfItsArmOverTheRadius) {
    std::mt19937_64 random(1);
    for (int round = 0; round < 200; ++round) {
        const PhysicsSettings settings = both_settings()[round % 2];
        const bool coloured = round / 2 % 2;
        const double dt = std::array{1.0 / 60, kStep, 1.0 / 1000}[round % 3];
        const Ball ball = random_ball(random);
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        const BodyId id = add_ball(bodies, ball);
        Stepper world(make_simulation(bodies, settings), coloured ? 1 : kNoneColoured);
        const double stops = ball.speed / ball.deceleration();
        const int steps = std::min(40 + round, static_cast<int>(stops / dt) - 1);
        ASSERT_GT(steps, 0);
        for (int i = 0; i < steps; ++i) world.step(dt);
        // A rounding of the place, 1e-16 m, is 1e-13 m/s in a step. In float each step rounds its
        // change of the speed by some 1e-7 of itself.
        expect_slowed(ball, world.bodies(), id, steps * dt, coloured ? 1e-6 : 1e-10);
    }
}

TEST(RollingFriction, StopsABallAndLeavesItAtRest) {
    std::mt19937_64 random(2);
    for (int round = 0; round < 40; ++round) {
        Ball ball = random_ball(random);
        ball.rolling_friction = ball.radius * uniform(random, 0.05, 0.2);
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        const BodyId id = add_ball(bodies, ball);
        Stepper world(make_simulation(bodies, both_settings()[round % 2]),
                      round / 2 % 2 ? 1 : kNoneColoured);
        const double a = ball.deceleration(), time = ball.speed / a;
        run(world, static_cast<int>(std::ceil(1.1 * time / kStep)));
        EXPECT_LT(world.bodies().velocity[id].norm(), 1e-6 * ball.speed) << round;
        // In the step in which it stops it may go on by that step's way.
        const double way = 0.5 * ball.speed * time;
        EXPECT_NEAR(world.bodies().position[id].dot(ball.t), way, a * kStep * kStep + 1e-6 * way);
    }
}

/// On a slab that can turn, but is far too heavy to, so that all are one island.
TEST(RollingFriction, SlowsManyBallsOfOneLargeIsland) {
    for (const PhysicsSettings& settings : both_settings()) {
        std::mt19937_64 random(3);
        Bodies bodies;
        BodyType slab = rolling_type(box_type({200, 2, 200, 200}, 1e12), 0);
        slab.fixed_position = true;
        add(bodies, slab, -Vec4::UnitY());
        std::vector<Ball> balls;
        for (int i = 0; i < 1100; ++i) {
            Ball ball = random_ball(random);
            ball.radius = uniform(random, 0.1, 1), ball.mass = uniform(random, 1, 10);
            ball.rolling_friction = ball.radius * uniform(random, 0.001, 0.2);
            balls.push_back(ball);
            add_ball(bodies, ball, 8 * Vec4(i % 11 - 5, 0, i / 11 % 10 - 5, i / 110 - 5));
        }
        StageCopy copy(Stage::kFinishStep);
        Stepper world(bodies, settings);
        run(world, 9);
        world.observe(&copy);
        run(world, 1);
        ASSERT_EQ(copy.step.islands.size(), 1u);
        ASSERT_TRUE(copy.step.islands.is_coloured(0));
        for (BodyId id = 1; id < bodies.size(); ++id)
            expect_slowed(balls[id - 1], world.bodies(), id, 10 * kStep, 1e-6);
    }
}

/// Spin about the point of contact, in planes without the normal: the torque rolling_friction m g
/// against m R^2/3.
TEST(RollingFriction, SlowsABallThatTwistsInPlace) {
    std::mt19937_64 random(4);
    for (int round = 0; round < 100; ++round) {
        Ball ball = random_ball(random);
        const bool coloured = round / 2 % 2;
        const Vec4 p = along_floor(random), q = along_floor(random);
        const Bivector spin = wedge(p, q);
        const double first = uniform(random, 1, 20),
                     a = 3 * kGravity * ball.rolling_friction / (ball.radius * ball.radius);
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, 0.5));
        ball.speed = 0;
        const BodyId id = add_ball(bodies, ball);
        bodies.angular_velocity[id] = (first / norm(spin)) * spin;
        Stepper world(make_simulation(bodies, both_settings()[round % 2]),
                      coloured ? 1 : kNoneColoured);
        run(world, 10 + round);
        const double now = std::max(0.0, first - a * (10 + round) * kStep);
        EXPECT_LT(norm(world.bodies().angular_velocity[id] - (now / norm(spin)) * spin),
                  first * (coloured ? 1e-6 : 1e-10))
            << round;
        EXPECT_LT(world.bodies().velocity[id].norm(), ball.radius * first * 1e-6);
    }
}

/// A ball on a slope with that part of the steepest slope on which it rests.
Stepper ball_on_slope(double part, const PhysicsSettings& settings, std::uint32_t coloured_from) {
    const double angle = std::atan(0.1 * part);
    Bodies bodies;
    add(bodies, rolling_type(plane_type(Vec4::UnitY(), 0), 0.05, 0.5));
    add(bodies, rolling_type(sphere_type(0.5, 3), 0.01), 0.5 * Vec4::UnitY());
    PhysicsSettings tilted = settings;
    tilted.gravity =
        kGravity * Vec4(std::sin(angle) * 0.6, -std::cos(angle), 0, std::sin(angle) * 0.8);
    return Stepper(make_simulation(bodies, tilted), coloured_from);
}

TEST(RollingFriction, HoldsABallOnASlopeUpToTheArmOverTheRadius) {
    const Vec4 down(0.6, 0, 0, 0.8);
    for (const PhysicsSettings& settings : both_settings())
        for (const std::uint32_t coloured_from : {1u, kNoneColoured}) {
            for (const double part : {0.5, 0.9, 0.99}) {
                Stepper world = ball_on_slope(part, settings, coloured_from);
                run(world, 2400);
                // Ten seconds; unless each step starts from the last one's impulses it creeps.
                EXPECT_LT(world.bodies().position[1].dot(down), 5e-5) << part;
            }
            for (const double part : {1.05, 1.5}) {
                Stepper world = ball_on_slope(part, settings, coloured_from);
                run(world, 480);
                const double angle = std::atan(0.1 * part),
                             way = 0.5 * 0.75 * kGravity *
                                   (std::sin(angle) - 0.1 * std::cos(angle)) * 4;
                EXPECT_NEAR(world.bodies().position[1].dot(down), way, 0.02 * way) << part;
            }
        }
}

TEST(RollingFriction, IsNothingInTheAirAndWithoutFriction) {
    const auto end_of = [](double rolling, double floor_friction, double ball_friction,
                           double height) {
        Bodies bodies;
        add(bodies, rolling_type(plane_type(Vec4::UnitY(), 0), rolling, floor_friction));
        add(bodies, rolling_type(sphere_type(0.5, 1), rolling, ball_friction), {0, height, 0, 0},
            {1, 0, 2, 0}, {1, 2, 3, -1, 4, 0.5});
        Stepper world(bodies, PhysicsSettings{});
        run(world, 60);
        return world.bodies();
    };
    EXPECT_TRUE(same_bits(end_of(0.1, 0.5, 0.5, 5), end_of(0, 0.5, 0.5, 5)));
    EXPECT_TRUE(same_bits(end_of(0.1, 0, 0.5, 0.5), end_of(0, 0, 0.5, 0.5)));
    EXPECT_TRUE(same_bits(end_of(0.1, 0.5, 0, 0.5), end_of(0, 0.5, 0, 0.5)));
    EXPECT_FALSE(same_bits(end_of(0.1, 0.5, 0.5, 0.5), end_of(0, 0.5, 0.5, 0.5)));
}

/// As much of it as can be written: a ball slides like a block, slowed by friction alone.
TEST(RollingFriction, WithoutBoundsKeepsABallFromTurning) {
    for (const PhysicsSettings& settings : both_settings())
        for (const std::uint32_t coloured_from : {1u, kNoneColoured})
            for (const double most : {1e6, 1e300}) {
                Bodies bodies;
                add(bodies, rolling_type(plane_type(Vec4::UnitY(), 0), 0));
                add(bodies, rolling_type(sphere_type(0.5, 2), most), {0, 0.5, 0, 0}, {3, 0, 0, 4});
                Stepper world(make_simulation(bodies, settings), coloured_from);
                run(world, 120);
                const Vec4 v = world.bodies().velocity[1];
                EXPECT_LT((v - 0.5 * Vec4(3, 0, 0, 4)).norm(), 1e-5);  // 5 - 0.5 g t, of floats
                EXPECT_LT(norm(world.bodies().angular_velocity[1]), 1e-5);
            }
}

/// Across its length, on both of its ends: the floor takes rolling_friction m g a radian.
TEST(RollingFriction, TakesACapsulesEnergyByTheAngleThatItRolls) {
    const double radius = 0.3, mass = 2, rolling_friction = 0.02, speed = 1.5;
    for (const PhysicsSettings& settings : {PhysicsSettings{}, substepped_settings(10)})
        for (const std::uint32_t coloured_from : {1u, kNoneColoured}) {
            Bodies bodies;
            add(bodies, rolling_type(plane_type(Vec4::UnitY(), 0), 0));
            // Its axis, y in its frame, along x.
            const Rotor lies = exp(Bivector{0.25 * pi, 0, 0, 0, 0, 0});
            const Vec4 t(0, 0, 0.6, 0.8);
            const BodyId id =
                add(bodies, rolling_type(capsule_type(radius, 1, mass), rolling_friction),
                    radius * Vec4::UnitY(), speed * t, (speed / radius) * wedge(Vec4::UnitY(), t),
                    lies);
            Stepper world(make_simulation(bodies, settings), coloured_from);
            double last = kinetic_energy(bodies);
            const double way = last / (rolling_friction * mass * kGravity) * radius;
            for (int i = 0; i < 2400; ++i) {
                world.step(kStep);
                const double energy = kinetic_energy(world.bodies());
                // At rest it moves below the tolerance, that is by up to 1e-8 J.
                EXPECT_LE(energy, last + mass / 2 * settings.tolerance * settings.tolerance);
                last = energy;
            }
            EXPECT_LT(last, 1e-12);
            EXPECT_NEAR(world.bodies().position[id].dot(t), way, 1e-3 * way);
            EXPECT_NEAR(world.bodies().position[id][0], 0, 1e-6);
        }
}

/// Bodies of all shapes that lie on each other, settle, turn and hit each other.
Bodies mixed_heap_that_rolls() {
    Bodies bodies = mixed_heap();
    for (BodyType& type : bodies.types) type.rolling_friction = 0.03;
    return bodies;
}

TEST(RollingFriction, StaysWithinItsPartOfEveryNormalImpulse) {
    for (const PhysicsSettings& settings : both_settings())
        for (const std::uint32_t coloured_from : {1u, kNoneColoured}) {
            StageCopy copy(Stage::kFinishStep);
            Stepper world(make_simulation(mixed_heap_that_rolls(), settings), coloured_from);
            run(world, 100);
            world.observe(&copy);
            int pushed = 0, at_limit = 0, below = 0;
            for (int i = 0; i < 20; ++i) {
                world.step(kStep);
                const StepData& step = copy.step;
                ASSERT_EQ(step.angular_impulses.size(), step.contacts.size());
                for (std::size_t c = 0; c < step.contacts.size(); ++c) {
                    const double normal = step.impulses[c].normal;
                    const Bivector all = step.angular_impulses[c];
                    const Vec4& n = step.contacts[c].normal;
                    const Bivector rolling = wedge(n, velocity_at(all, n));
                    // In float both parts are told apart to 1e-7 of what would end all turning,
                    // which is more than a hundred times as much where a ball spins fast.
                    const double most = 0.03 * normal * (1 + 1e-4);
                    EXPECT_LE(norm(rolling), most);
                    EXPECT_LE(norm(all - rolling), most);
                    pushed += normal > 0;
                    at_limit += norm(rolling) > 0.9999 * 0.03 * normal && normal > 0;
                    below += norm(rolling) < 0.9 * 0.03 * normal;
                }
            }
            EXPECT_GT(pushed, 500);
            EXPECT_GT(at_limit, 50);
            EXPECT_GT(below, 50);
        }
}

TEST(RollingFriction, NeverAddsEnergy) {
    std::mt19937_64 random(6);
    double lost = 0;
    for (int round = 0; round < 300; ++round) {
        PhysicsSettings settings = both_settings()[round % 2];
        settings.gravity.setZero();
        Bodies bodies;
        const double restitution = round / 4 % 3 * 0.5, friction = round / 12 % 2 ? 0.3 : 1.5;
        for (const double side : {-1.0, 1.0}) {
            const int shape = static_cast<int>(random() % 3);
            const double mass = std::exp(uniform(random, -2, 2));
            BodyType type = shape == 0   ? sphere_type(0.5, mass)
                            : shape == 1 ? capsule_type(0.4, 0.6, mass)
                                         : box_type({0.9, 1.1, 0.7, 1}, mass);
            type = rolling_type(type, uniform(random, 0, 0.3), friction);
            type.restitution = restitution;
            const Vec4 place = side * Vec4(1.2, 0, 0, 0) + random_vector(random, 0.2);
            const Vec4 velocity = -side * Vec4(2, 0, 0, 0) + random_vector(random, 0.5);
            const Vec4 a = random_vector(random, 3), b = random_vector(random, 3);
            const Bivector turn = {a[0], a[1], a[2], b[0], b[1], b[2]};
            add(bodies, type, place, velocity, turn, exp(turn));
        }
        Stepper world(make_simulation(bodies, settings), round / 2 % 2 ? 1 : kNoneColoured);
        const double first = kinetic_energy(bodies);
        double before = first;
        for (int i = 0; i < 240; ++i) {
            const StepReport report = world.step(kStep);
            const double energy = kinetic_energy(world.bodies());
            // Floats are rounded by 6e-8. What parts bodies that overlap does work on them.
            EXPECT_LT(energy, (1 + 1e-6) * (report.penetration > 0 ? first : before)) << round;
            before = energy;
        }
        lost += (first - before) / first;
    }
    EXPECT_GT(lost, 30) << "no impacts";
}

/// A ball on eight that touch each other drives them apart where they can roll, and rests on them
/// where they cannot.
TEST(RollingFriction, KeepsAHeapFromFlowing) {
    const auto spread_of = [](double rolling_friction) {
        Bodies bodies;
        add(bodies, rolling_type(plane_type(Vec4::UnitY(), 0), rolling_friction, 0.5));
        const BodyType ball = rolling_type(sphere_type(0.5, 1), rolling_friction, 0.5);
        for (int i = 0; i < 8; ++i)
            add(bodies, ball, {i % 2 - 0.5, 0.5, i / 2 % 2 - 0.5, i / 4 - 0.5});
        add(bodies, ball, {0.02, 1.0, 0.01, -0.01});
        Stepper world(bodies, PhysicsSettings{});
        run(world, 720);
        double spread = 0;
        for (BodyId id = 1; id < 9; ++id)
            spread = std::max(spread, (world.bodies().position[id] - bodies.position[id]).norm());
        return spread;
    };
    EXPECT_GT(spread_of(0), 0.5);
    EXPECT_LT(spread_of(0.4), 0.05);
}

/// The planks of a bridge: solved one by one, they were pressed askew by what did not know yet that
/// it rested on the next one, whose edge then slowed it, by 5 and 12 % in all.
TEST(Rolling, OverLoosePlanksLosesNoSpeed) {
    for (const double times : {3.0, 20.0}) {
        constexpr double kRadius = 0.06, kSpeed = 0.8, kPlank = 0.08;
        Bodies bodies;
        BodyType rail = box_type({8, 0.06, 0.04, 0.4});
        rail.fixed_position = rail.fixed_rotation = true;
        BodyType plank = box_type({0.1, 0.02, 0.32, 0.2}, kPlank);
        BodyType ball = sphere_type(kRadius, times * kPlank);
        rail.friction = plank.friction = ball.friction = 0.6;
        for (const double z : {-0.12, 0.12}) add(bodies, rail, {1, -0.05, z, 0});
        for (int i = 0; i < 14; ++i) add(bodies, plank, {0.101 * i, -0.01, 0, 0});
        Bivector rolling;
        rolling.xy = -kSpeed / kRadius;
        const BodyId id = add(bodies, ball, {0, kRadius, 0, 0}, {kSpeed, 0, 0, 0}, rolling);
        Stepper world(bodies, PhysicsSettings{});
        while (world.bodies().position[id][0] < 1.3 && world.memory().time < 3) world.step(kStep);
        // A joint of d lets it down by d^2 / 8R: of its energy so much is lost for each.
        EXPECT_GT(world.bodies().velocity[id][0], 0.99 * kSpeed) << times;
        EXPECT_LT(world.bodies().velocity[id][0], 1.001 * kSpeed) << times;
    }
}

}  // namespace
}  // namespace tesserae
