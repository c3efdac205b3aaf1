// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bench/experiments/experiments.hpp"

// Spheres that meet on a line, without gravity or friction.
namespace tesserae::bench {
namespace {

/// As many pairs at once, 10 m apart, that start a little differently: the error depends on where
/// in its step the collision falls, and the largest of several shows the order.
constexpr int kCopies = 8;

Vec4 place(int copy) { return {0, 0, 10.0 * copy, 0}; }

}  // namespace

/// Equal masses, e = 1: velocities swap when the gap is closed.
Experiment head_on(const Knobs& knobs) {
    const Vec4 n = Vec4(1, -2, 0, 1).normalized();
    const double v0 = 3, v1 = -1.25;
    const auto settings = settings_of(2, knobs, Vec4::Zero());
    const auto half_distance = [](int copy) { return 2 + 0.0371 * copy; };
    Bodies bodies;
    bodies.types.push_back(sphere_type(kRadius, 2, 0.5, 1));
    for (int i = 0; i < kCopies; ++i) {
        add(bodies, 0u, place(i) - half_distance(i) * n, v0 * n);
        add(bodies, 0u, place(i) + half_distance(i) * n, v1 * n);
    }
    return {"head_on", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                double velocity_error = 0, position_error = 0;
                const auto compare = [&](std::size_t id, const Vec4& x, const Vec4& v) {
                    const Bodies& now = trial.bodies();
                    velocity_error = std::max(velocity_error, (now.velocity[id] - v).norm());
                    position_error = std::max(position_error, (now.position[id] - x).norm());
                };
                for (int i = 0; i < kCopies; ++i) {
                    const double half = half_distance(i);
                    const double t = (2 * half - 2 * kRadius) / (v0 - v1);
                    const double after = settings.duration - t;
                    const auto id = static_cast<std::size_t>(2 * i);
                    compare(id, place(i) + (-half + v0 * t + v1 * after) * n, v1 * n);
                    compare(id + 1, place(i) + (half + v1 * t + v0 * after) * n, v0 * n);
                }
                return {{"velocity", "m/s", velocity_error}, {"position", "m", position_error}};
            }};
}

namespace {

/// Equal spheres in a row, the first of which moves, e = 1: each collision hands the velocity on,
/// so that the last leaves with v0 when all gaps have been crossed, and the others are at rest.
Experiment chain_of(const char* name, double gap, const Knobs& knobs) {
    constexpr int kCount = 8;
    constexpr double kSpeed = 2;
    const auto settings = settings_of(1, knobs, Vec4::Zero());
    Bodies bodies;
    bodies.types.push_back(sphere_type(kRadius, 2, 0, 1));
    for (int i = 0; i < kCount; ++i)
        add(bodies, 0u, {i * (2 * kRadius + gap), 0, 0, 0}, {i == 0 ? kSpeed : 0, 0, 0, 0});
    return {name, bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                const Bodies& now = trial.bodies();
                double others = 0, energy_part = 0;
                for (std::size_t i = 0; i < kCount; ++i) {
                    const double speed = now.velocity[i].norm();
                    if (i + 1 < kCount) others = std::max(others, speed);
                    energy_part += speed * speed / (kSpeed * kSpeed);
                }
                const double left = (kCount - 1) * gap / kSpeed;
                const double exact =
                    bodies.position[kCount - 1][0] + kSpeed * (settings.duration - left);
                return {
                    {"velocity of the last", "relative",
                     std::abs(now.velocity[kCount - 1][0] / kSpeed - 1)},
                    {"speed of the others", "relative to v0", others / kSpeed},
                    {"position of the last", "m", std::abs(now.position[kCount - 1][0] - exact)},
                    {"energy", "relative", std::abs(energy_part - 1)}};
            }};
}

}  // namespace

/// Gaps that are crossed in several steps: one collision a step.
Experiment chain(const Knobs& knobs) { return chain_of("chain", 0.1, knobs); }

/// Gaps shorter than a step at any rate used here: all collisions in one step.
Experiment close_chain(const Knobs& knobs) { return chain_of("close_chain", 0.0005, knobs); }

/// m1 meets m2 at rest: v1 = (m1 - e m2) v/(m1 + m2), v2 = (1 + e) m1 v/(m1 + m2). One pair for
/// each e; e = 0 leaves the pair in touch.
Experiment unequal_masses(const Knobs& knobs) {
    constexpr double kSpeed = 3, kFirst = 1, kSecond = 3.5;
    const auto settings = settings_of(1, knobs, Vec4::Zero());
    const std::vector<double> restitutions = {0, 0.25, 0.5, 0.75, 1};
    Bodies bodies;
    for (std::size_t i = 0; i < restitutions.size(); ++i) {
        const double e = restitutions[i];
        const Vec4 start = place(static_cast<int>(i));
        add(bodies, sphere_type(kRadius, kFirst, 0, e), start, {kSpeed, 0, 0, 0});
        add(bodies, sphere_type(0.4, kSecond, 0, e), start + Vec4(1.5, 0, 0, 0));
    }
    return {"unequal_masses", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                double worst = 0;
                for (std::size_t i = 0; i < restitutions.size(); ++i) {
                    const double e = restitutions[i], sum = kFirst + kSecond;
                    const double v1 = (kFirst - e * kSecond) * kSpeed / sum;
                    const double v2 = (1 + e) * kFirst * kSpeed / sum;
                    const Bodies& now = trial.bodies();
                    worst = std::max({worst, std::abs(now.velocity[2 * i][0] - v1),
                                      std::abs(now.velocity[2 * i + 1][0] - v2)});
                }
                return {{"velocity", "m/s", worst}};
            }};
}

}  // namespace tesserae::bench
