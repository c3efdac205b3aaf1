// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "core/dynamics/step/stage_copy.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/core/dynamics/builder.hpp"

// One point of a rough body hits a plane, turning and aslant, in a plane of motion: beside the
// closed form of Stronge ("Rigid body collisions with friction", 1990), which follows slip and
// approach over the impulse and gives back e^2 of the work of the compression along the normal.
namespace tesserae {
namespace {

using namespace tesserae::testing;

/// What impulses change of the velocity of a point: along the surface (t) and away from it (n).
struct PlanarResponse {
    double tt, tn, nn;  ///< [1/kg]
};

struct PlanarImpact {
    double t, n;       ///< velocity of the point afterwards [m/s]
    std::string path;  ///< pieces of constant slip: + or -, 0 (sticks), J (jams), | at the turn
};

/// The motion is linear in the normal impulse p between the ends of slip, of compression and of
/// restitution. Friction is against the slip; where that has ended it holds if it can, else slip
/// goes on the other way.
PlanarImpact stronge_impact(const PlanarResponse& k, double t, double n, double friction,
                            double e) {
    constexpr double kNever = std::numeric_limits<double>::max();
    PlanarImpact impact{t, n, ""};
    double work = 0, left = 0;
    for (bool restitution = false; impact.path.size() < 20;) {
        char piece = impact.t > 0 ? '+' : '-';
        double q = impact.t > 0 ? -friction : friction;  // friction's part of the normal impulse
        if (impact.t == 0 && std::abs(k.tn) <= friction * k.tt) {
            piece = '0', q = -k.tn / k.tt;
        } else if (impact.t == 0) {
            piece = k.tn > 0 ? '+' : '-', q = k.tn > 0 ? -friction : friction;
        }
        const double a = piece == '0' ? 0 : k.tt * q + k.tn, b = k.tn * q + k.nn;
        impact.path += b > 0 ? piece : 'J';
        const double to_stick = impact.t * a < 0 ? -impact.t / a : kNever;
        const double root = impact.n * impact.n + 2 * b * left;
        double to_end = b > 0 ? -impact.n / b : kNever;  // of compression
        if (restitution) to_end = root >= 0 ? 2 * left / (impact.n + std::sqrt(root)) : kNever;
        const double p = std::min(to_stick, to_end);
        const double done = impact.n * p + 0.5 * b * p * p;
        (restitution ? left : work) -= done;
        impact.t = to_stick <= to_end ? 0 : impact.t + a * p;
        impact.n += b * p;
        if (to_stick < to_end) continue;
        if (restitution) break;
        restitution = true;
        impact.n = 0, left = e * e * work;
        impact.path += '|';
    }
    return impact;
}

/// A capsule or ball thrown at a plane, its motion in x and y, and what the impact made of it.
struct Bounce {
    double friction, e;
    bool round;
    PlanarResponse k;
    Vec4 before, compressed, after;  ///< of the point that hits [m/s]
    PlanarImpact expected;

    /// Twice the kinetic energy that an impact can change [J].
    double energy(const Vec4& v) const {
        const double t = v[0], n = v[1];
        return (k.nn * t * t - 2 * k.tn * t * n + k.tt * n * n) / (k.tt * k.nn - k.tn * k.tn);
    }
    /// Largest friction that leaves the solver's sweeps converging: more, and what it does to the
    /// approach outweighs what the normal impulse does.
    bool converges() const { return friction * std::abs(k.tn) < 0.9 * k.nn; }
};

template <class See>
void for_each_bounce(const See& see) {
    std::mt19937_64 random(1);
    const auto uniform = [&](double least, double most) {
        return std::uniform_real_distribution<>(least, most)(random);
    };
    for (int round = 0; round < 6000; ++round) {
        Bounce bounce;
        bounce.friction = std::array{0.0, 0.2, 0.5, 1.0, 2.0}[random() % 5];
        bounce.e = uniform(0.05, 1);
        bounce.round = random() % 4 == 0;
        const double radius = uniform(0.05, 0.5), angle = uniform(-1.2, 1.2);
        const double length = bounce.round ? 0 : uniform(0.2, 2), fall = uniform(1, 6);
        const double along = random() % 3 == 0 ? 0 : uniform(-6, 6);
        BodyType type = bounce.round ? sphere_type(radius, 2) : capsule_type(radius, length, 2);
        type.friction = bounce.friction, type.restitution = bounce.e;
        Bodies bodies;
        add(bodies, plane_type(Vec4::UnitY(), 0, bounce.friction, bounce.e));
        const double height = 0.5 * length * std::cos(angle) + radius + 0.3 * fall * kStep;
        const BodyId id =
            add(bodies, type, {0, height, 0, 0}, {along, -fall, 0, 0},
                Bivector{uniform(-8, 8), 0, 0, 0, 0, 0}, exp(Bivector{0.5 * angle, 0, 0, 0, 0, 0}));
        Stepper world(bodies, without_gravity());
        StageCopy copy(Stage::kIntegrateVelocities);  // the impact is over
        world.observe(&copy);
        world.step(kStep);
        const StepData& step = copy.step;
        if (step.contacts.size() != 1) continue;

        const Vec4 r = step.contacts[0].point - step.position[id];
        const TypeProperties& properties = copy.simulation.type_of(id);
        const double m = properties.inverse_mass, i = properties.inverse_inertia.xy;
        bounce.k = {m + i * r[1] * r[1], -i * r[0] * r[1], m + i * r[0] * r[0]};
        const auto of_point = [&](const Vec4& v, const Bivector& omega) -> Vec4 {
            return v + velocity_at(omega, r);
        };
        bounce.before = of_point(bodies.velocity[id], bodies.angular_velocity[id]);
        const double approach = -bounce.before[1];
        if (!(approach > 0.1) || step.contacts[0].separation > 0.9 * approach * kStep) continue;
        const BodyMotion& compressed = step.impact_motion[id].compressed;
        bounce.compressed = of_point(compressed.velocity, compressed.angular_velocity);
        bounce.after = of_point(step.velocity[id], step.angular_velocity[id]);
        bounce.expected =
            stronge_impact(bounce.k, bounce.before[0], bounce.before[1], bounce.friction, bounce.e);
        see(bounce);
    }
}

double difference(const Bounce& bounce) {
    return std::hypot(bounce.after[0] - bounce.expected.t, bounce.after[1] - bounce.expected.n) /
           bounce.before.norm();
}

/// A ball's normal and tangent responses are apart: p = (1 + e) m v_n, and friction either ends the
/// slip u or is as large as it can be.
TEST(Stronge, ClosedFormOfABallIsNewtons) {
    const PlanarResponse k{0.5 + 1.5, 0, 0.5};
    for (const double u : {-7.0, -0.3, 0.4, 5.0})
        for (const double e : {0.1, 0.5, 1.0}) {
            const PlanarImpact impact = stronge_impact(k, u, -3, 0.3, e);
            const double most = 0.3 * (1 + e) * 3 / k.nn * k.tt;
            EXPECT_NEAR(impact.n, 3 * e, 1e-12);
            EXPECT_NEAR(impact.t, std::copysign(std::max(0.0, std::abs(u) - most), u), 1e-12);
        }
}

TEST(Stronge, ABallAndASmoothBodyBounceAsInTheClosedForm) {
    int balls = 0, smooth = 0;
    for_each_bounce([&](const Bounce& bounce) {
        if (!bounce.round && bounce.friction > 0) return;
        ++(bounce.round ? balls : smooth);
        EXPECT_LT(difference(bounce), 1e-12) << bounce.expected.path;
    });
    EXPECT_GT(balls, 1000);
    EXPECT_GT(smooth, 600);
}

/// Where it slips one way all the time, Newton's, Poisson's and Stronge's ratios are the same one.
TEST(Stronge, ARoughBodyThatSlipsOneWayBouncesAsInTheClosedForm) {
    int bounces = 0;
    for_each_bounce([&](const Bounce& bounce) {
        const std::string& path = bounce.expected.path;
        if (bounce.round || bounce.friction == 0 || !bounce.converges()) return;
        if (path != "+|+" && path != "-|-") return;
        ++bounces;
        EXPECT_LT(difference(bounce), 1e-4) << bounce.friction;  // kImpactResidual
    });
    EXPECT_GT(bounces, 500);
}

/// Where slip ends or turns round the end of the compression is found at once, not along the way,
/// and restitution is Newton's, so that the impact is another one than Stronge's. What holds of
/// all: the compression stops the point, no more energy comes back than e^2 of what it took, and
/// the point leaves at e times the speed of its approach at most.
TEST(Stronge, WhereSlipChangesNoMoreEnergyIsReturned) {
    std::map<std::string, std::array<double, 2>> apart;  // number, sum of the differences
    for_each_bounce([&](const Bounce& bounce) {
        if (!bounce.converges()) return;
        const double e = bounce.e, before = bounce.energy(bounce.before);
        const double taken = before - bounce.energy(bounce.compressed);
        const double returned = bounce.energy(bounce.after) - bounce.energy(bounce.compressed);
        EXPECT_NEAR(bounce.compressed[1], 0, 1e-3 * bounce.before.norm());
        EXPECT_LT(returned, e * e * taken + 1e-12 * before) << bounce.expected.path;
        // Less by what is left of the approach where the sweeps end.
        EXPECT_LT(bounce.after[1], -e * bounce.before[1] + 3e-4 * bounce.before.norm());
        if (bounce.round || bounce.friction == 0) return;
        auto& [count, sum] = apart[bounce.expected.path];
        ++count, sum += difference(bounce);
    });
    // Sticks before or after the turn; slips the other way before or after it.
    for (const char* path : {"+0|0", "-0|0", "+|+0", "-|-0", "+-|-", "-+|+", "+|+-", "-|-+"}) {
        const auto& [count, sum] = apart[path];
        EXPECT_GT(count, 15) << path;
        EXPECT_LT(sum / count, 0.15) << path;
    }
}

}  // namespace
}  // namespace tesserae
