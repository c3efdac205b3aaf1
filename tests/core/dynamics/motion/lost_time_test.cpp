// SPDX-License-Identifier: Apache-2.0
// What is stopped where it touches goes on in the same sub-step.
#include "core/dynamics/motion/lost_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae {
namespace {

using namespace tesserae::testing;

/// A ball that a smooth wall stops flies on along it: z = v t.
TEST(LostTime, OfABallThatFliesAlongAWallIsRegained) {
    for (const bool substeps : {false, true})
        for (const double sizes : {1.5, 4.0, 13.0})  // a step
            for (const double gap : {0.1, 2.0, 5.3, 9.7}) {
                Bodies bodies;
                BodyType wall = box_type({0.01, 1e3, 1e3, 1e3});
                wall.fixed_position = wall.fixed_rotation = true;
                add(bodies, wall);
                BodyType ball = sphere_type(0.1);
                ball.friction = 0;
                add(bodies, ball, {-0.105 - gap, 0, 0, 0}, {0.2 * sizes * 240, 0, 30, 0});
                PhysicsSettings settings = substeps ? substepped_settings() : PhysicsSettings{};
                settings.gravity.setZero();
                Stepper world(bodies, settings);
                run(world, 24);
                EXPECT_NEAR(world.bodies().position[1][2], 24 * kStep * 30, 1e-9)
                    << sizes << ' ' << gap;
            }
}

/// A plate of 1 m that flies along x and turns in the plane of x and w, towards a smooth plane that
/// is at x = 0: in two dimensions a rectangle.
struct Plate {
    static constexpr double kThickness = 0.01, kInertia = (1 + kThickness * kThickness) / 12;
    double x, speed, angle, spin;
    int hits = 0;

    /// How far it reaches along x.
    static double reach(double angle) {
        return 0.5 * (kThickness * std::abs(std::cos(angle)) + std::abs(std::sin(angle)));
    }
    /// Moves on for a short time, then ends the approach of the edge that has met the plane.
    void move(double dt) {
        x += dt * speed, angle += dt * spin;
        if (x > reach(angle)) return;
        const double lever = (reach(angle + 1e-7) - reach(angle - 1e-7)) / 2e-7;
        const double approach = lever * spin - speed;
        if (!(approach > 0)) return;
        const double impulse = approach / (1 + lever * lever / kInertia);
        speed += impulse, spin -= impulse * lever / kInertia;
        ++hits;
    }
};

/// At 60 steps a second, in which it flies 1.7 m and turns by 48 degrees, against steps of 0.1 us:
/// it reacts when it touches, and then goes on. What is about to touch in the middle of a step
/// reacts there, before it has turned by another 4 degrees.
TEST(LostTime, OfAPlateThatWhirlsIsRegainedAfterItHasTouched) {
    constexpr double kRate = 60;
    constexpr int kFineSteps = 166667;
    int hits = 0, exact = 0;
    for (int i = 0; i < 40; ++i) {
        Plate plate{3 + 0.11 * i, -100, 0, 50};
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitX(), 0));
        BodyType type = box_type({Plate::kThickness, 1, 1, 1});
        type.friction = 0;
        add(bodies, type, plate.x * Vec4::UnitX(), plate.speed * Vec4::UnitX(),
            {0, 0, plate.spin, 0, 0, 0});
        Stepper world(bodies, without_gravity());
        while (plate.hits == 0) {
            for (int k = 0; k < kFineSteps; ++k) plate.move(1 / kRate / kFineSteps);
            world.step(1 / kRate);
        }
        if (plate.hits > 1) continue;
        ++hits;
        const double speed_off = world.bodies().velocity[1][0] - plate.speed;
        const double spin_off = world.bodies().angular_velocity[1].xw - plate.spin;
        EXPECT_NEAR(world.bodies().position[1][0], plate.x, 0.02) << i;
        EXPECT_LT(std::abs(speed_off), 15) << i;
        EXPECT_LT(std::abs(spin_off), 15) << i;
        exact += std::abs(speed_off) < 0.1 && std::abs(spin_off) < 0.5;
    }
    EXPECT_GT(hits, 10);
    EXPECT_GT(exact, 0.7 * hits);
}

}  // namespace
}  // namespace tesserae
