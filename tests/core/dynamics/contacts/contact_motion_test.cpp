// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace testing;

constexpr double kRadius = 0.5;
/// A sum of some 500 rounded steps of quantities around 1; far below any modelling error.
constexpr double kMotionRounding = 1e-11;

/// A sphere (body 1) on or above the plane y = 0 (body 0).
Stepper sphere_on_plane(double friction, double restitution, const Vec4& gravity, double gap,
                        const Vec4& velocity) {
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, friction, restitution));
    add(bodies, sphere_type(kRadius, 2, friction, restitution), {0, kRadius + gap, 0, 0}, velocity);
    PhysicsSettings settings;
    settings.gravity = gravity;
    return Stepper(bodies, settings);
}

void run_for(Stepper& world, double time, int steps_per_second) {
    const int steps = static_cast<int>(std::lround(time * steps_per_second));
    for (int i = 0; i < steps; ++i) world.step(1.0 / steps_per_second);
}

TEST(Sliding, TurnsIntoRollingAtThreeQuartersOfTheSpeed) {
    // In the direction (3, 4)/5 of the plane z w. Slip v - omega R starts at v0 and falls by
    // mu g (1 + 3) a second: it ends at t = v0/(4 mu g) = 0.3 s.
    const double v0 = 3.6, mu = 0.3;
    const Vec4 direction{0, 0, 0.6, 0.8};
    Stepper world = sphere_on_plane(mu, 0, kDown, 0, v0 * direction);
    run_for(world, 0.25, 240);
    EXPECT_LT((world.bodies().velocity[1] - (v0 - mu * 10 * 0.25) * direction).norm(),
              kMotionRounding);
    run_for(world, 0.75, 240);
    EXPECT_LT((world.bodies().velocity[1] - 0.75 * v0 * direction).norm(), kMotionRounding);
    EXPECT_NEAR(norm(world.bodies().angular_velocity[1]), 0.75 * v0 / kRadius, kMotionRounding);
    EXPECT_NEAR(world.bodies().position[1][1], kRadius, kMotionRounding);
}

TEST(Sliding, CoversTheRightDistanceToSecondOrder) {
    const double v0 = 3.7, mu = 0.3;
    const double t = v0 / (4 * mu * 10);
    const double exact = v0 * t - 0.5 * mu * 10 * t * t + 0.75 * v0 * (1 - t);
    for (int steps_per_second : {60, 240, 960}) {
        Stepper world = sphere_on_plane(mu, 0, kDown, 0, {v0, 0, 0, 0});
        run_for(world, 1, steps_per_second);
        // Exact on either side of the change; in its step the acceleration of 3 m/s^2 acts for a
        // wrong time of at most h while the speed is right at both ends.
        const double h = 1.0 / steps_per_second;
        EXPECT_NEAR(world.bodies().position[1][0], exact, 0.5 * mu * 10 * h * h + kMotionRounding);
    }
}

TEST(Sliding, BrakesABoxOfAnyYawAgainstItsVelocity) {
    // It lies on a cell of eight corners, whose response to an impulse is not the same in all
    // tangent directions. Friction is mu m g against the velocity; box and path do not turn.
    const double v0 = 3, mu = 0.5, t = 0.5;
    const Vec4 direction{0.48, 0, 0.6, 0.64};
    BodyType box = box_type({0.5, 0.2, 0.3, 0.4}, 2);
    box.friction = mu;
    for (double yaw : {0.0, 0.6}) {
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, mu));
        const Rotor rotor = exp(Bivector{0, -0.5 * yaw, 0, 0, 0, 0});
        add(bodies, box, {0, 0.1, 0, 0}, v0 * direction, {}, rotor);
        PhysicsSettings settings;
        settings.gravity = kDown;
        settings.iterations = 300;  // until nothing changes
        settings.tolerance = 0;
        Stepper world(bodies, settings);
        run_for(world, t, 240);
        const double travel = v0 * t - 0.5 * mu * 10 * t * t;
        const Vec4 end = Vec4{0, 0.1, 0, 0} + travel * direction;
        EXPECT_LT((world.bodies().position[1] - end).norm(), 1e-9) << yaw;
        EXPECT_LT(norm(world.bodies().angular_velocity[1]), 1e-9) << yaw;
    }
}

TEST(Incline, LetsASphereRollOrSlipAtTheExactAcceleration) {
    for (double degrees : {5.0, 20.0, 40.0, 60.0})
        for (double mu : {0.05, 0.2, 0.6}) {
            const double angle = degrees * pi / 180;
            const Vec4 gravity{10 * std::sin(angle), -10 * std::cos(angle), 0, 0};
            Stepper world = sphere_on_plane(mu, 0, gravity, 0, Vec4::Zero());
            run_for(world, 1, 240);
            const bool rolls = mu >= std::tan(angle) / 4;
            const double a =
                rolls ? 0.75 * 10 * std::sin(angle) : 10 * (std::sin(angle) - mu * std::cos(angle));
            EXPECT_NEAR(world.bodies().velocity[1][0], a, kMotionRounding) << degrees << " " << mu;
            EXPECT_NEAR(world.bodies().position[1][0], 0.5 * a, kMotionRounding)
                << degrees << " " << mu;
        }
}

/// The greatest heights between bounces, at the times of the steps.
std::vector<double> heights(Stepper& world, int steps_per_second, std::size_t count) {
    std::vector<double> tops;
    double top = world.bodies().position[1][1] - kRadius;  // it starts at rest
    bool rising = true;
    for (int i = 0; i < 20 * steps_per_second && tops.size() < count; ++i) {
        world.step(1.0 / steps_per_second);
        const double v = world.bodies().velocity[1][1];
        const double height = world.bodies().position[1][1] - kRadius;
        if (v > 0 && !rising) top = 0;
        if (v <= 0 && rising) tops.push_back(std::max(top, height));
        rising = v > 0;
        top = std::max(top, height);
    }
    return tops;
}

TEST(Bounce, HeightsFallAsTheSquareOfRestitution) {
    for (int steps_per_second : {60, 240, 1000})
        for (double e : {1.0, 0.8, 0.5}) {
            Stepper world = sphere_on_plane(0, e, kDown, 1, Vec4::Zero());
            const auto tops = heights(world, steps_per_second, 4);
            ASSERT_EQ(tops.size(), 4u);
            // The true top lies within half a step of a step: it is at most g (h/2)^2 / 2 higher.
            const double missed = 10.0 / 8 / steps_per_second / steps_per_second;
            for (std::size_t k = 0; k < tops.size(); ++k) {
                const double exact = std::pow(e, 2.0 * static_cast<double>(k));
                EXPECT_LE(tops[k], exact + kMotionRounding) << e << " " << k;
                EXPECT_GE(tops[k], exact - missed - kMotionRounding) << e << " " << k;
            }
        }
}

TEST(Bounce, KeepsEnergyExactlyWhenItIsElastic) {
    Stepper world = sphere_on_plane(0, 1, kDown, 1, {0.3, 0, 0, 0});
    const auto energy = [&] {
        return kinetic_energy(world.bodies()) + potential_energy(world.bodies(), kDown);
    };
    const double before = energy();
    for (int i = 0; i < 4800; ++i) {
        world.step(1.0 / 240);
        ASSERT_NEAR(energy(), before, 1e-11 * before) << i;  // 4800 rounded steps
    }
}

TEST(Bounce, ComesLateByAtMostAStep) {
    // Dropped from 1 m with e = 0.8: hits at t1 = sqrt(2/g) with v = sqrt(2 g), leaves with 0.8 v.
    const double e = 0.8, t1 = std::sqrt(0.2), v = std::sqrt(20.0), t = 0.8;
    const double exact = e * v * (t - t1) - 5 * (t - t1) * (t - t1);
    for (int steps_per_second : {60, 240, 960, 3840}) {
        Stepper world = sphere_on_plane(0, e, kDown, 1, Vec4::Zero());
        run_for(world, t, steps_per_second);
        // The bounce is put into the middle of the step before the surface would be passed: up to
        // h too early, 1.5 h with the half step. Bodies that should be falling at v rise at e v.
        const double height = world.bodies().position[1][1] - kRadius;
        EXPECT_NEAR(height, exact, 1.5 / steps_per_second * (1 + e) * v);
    }
}

TEST(Bounce, WithoutRestitutionComesToRestOnTheSurface) {
    Stepper world = sphere_on_plane(0.5, 0, kDown, 1, Vec4::Zero());
    run_for(world, 1, 240);
    for (int i = 0; i < 100; ++i) {
        const StepReport report = world.step(1.0 / 240);
        EXPECT_EQ(report.contacts, 1u);
        EXPECT_NEAR(world.bodies().position[1][1], kRadius, 1e-14);
        EXPECT_LT(world.bodies().velocity[1].norm(), 1e-14);
        EXPECT_LT(report.penetration, 1e-14);
    }
}

TEST(Collision, HeadOnOfEqualSpheresSwapsTheirVelocities) {
    Bodies bodies;
    const BodyType ball = sphere_type(kRadius, 2, 0.5, 1);
    const Vec4 n = Vec4(1, -2, 3, 1).normalized();
    add(bodies, ball, -2 * n, 3 * n);
    add(bodies, ball, 2 * n, -1.25 * n);
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(bodies, settings);
    run_for(world, 2, 240);
    EXPECT_LT((world.bodies().velocity[0] + 1.25 * n).norm(), kMotionRounding);
    EXPECT_LT((world.bodies().velocity[1] - 3 * n).norm(), kMotionRounding);
}

TEST(Collision, OfFastSpheresDoesNotTunnel) {
    // 600 m/s is 2.5 m a step, 25 radii; into a plane, and into a sphere of the same size.
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0));
    const BodyType ball = sphere_type(0.1, 1, 0, 0);
    for (int i = 0; i < 10; ++i) add(bodies, ball, {3.0 * i, 8 + 0.37 * i, 0, 0}, {0, -600, 0, 0});
    add(bodies, ball, {0, 50, -20, 0}, {0, 0, 600, 0});
    add(bodies, ball, {0, 50, 0, 0});
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(bodies, settings);
    for (int i = 0; i < 24; ++i) {
        EXPECT_LT(world.step(1.0 / 240).penetration, 1e-9);  // overlaps are rounding
    }
    for (BodyId id = 1; id <= 10; ++id) EXPECT_GT(world.bodies().position[id][1], 0.0999);
    EXPECT_LT(world.bodies().position[11][2], world.bodies().position[12][2] - 0.1999);
    EXPECT_NEAR(world.bodies().velocity[12][2], 300, 1e-9);  // e = 0: both at half the speed
}

TEST(Overlap, OfCoincidentSpheresIsTakenApart) {
    Bodies bodies;
    for (int i = 0; i < 2; ++i) add(bodies, sphere_type(kRadius), {1, 2, 3, 4});
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(bodies, settings);
    run_for(world, 1, 240);
    const Bodies& now = world.bodies();
    const double distance = (now.position[1] - now.position[0]).norm();
    EXPECT_GE(distance, 2 * kRadius - 0.005 * kRadius - 1e-12);  // all but the allowed overlap
    EXPECT_LT((now.velocity[0] + now.velocity[1]).norm(), kMotionRounding);
}

}  // namespace
}  // namespace tesserae
