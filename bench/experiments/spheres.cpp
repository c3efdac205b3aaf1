// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bench/experiments/experiments.hpp"
#include "core/error.hpp"

// Single spheres and one column of them.
namespace tesserae::bench {
namespace {

/// Motions with an event (a bounce, the end of slip) are made by this many bodies at once, 10 m
/// apart, that start a little differently: the error depends on where in its step the event falls,
/// and the largest of several shows the order.
constexpr int kCopies = 8;

Vec4 place(int copy) { return {0, 0, 10.0 * copy, 0}; }

}  // namespace

/// x = x0 + v t + g t^2 / 2.
Experiment projectile(const Knobs& knobs) {
    const Vec4 v{3, 10, -2, 1};
    const auto settings = settings_of(2, knobs, kDown);
    Bodies bodies;
    add(bodies, sphere_type(kRadius, 2, 0, 0), Vec4::Zero(), v);
    return {"projectile", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                const Vec4 exact = settings.duration * v + 2 * kDown;
                return {{"position", "m", (trial.bodies().position[0] - exact).norm()}};
            }};
}

namespace {

/// The bounces of one sphere, read off the parabola on which it flies after each, so that the
/// step's length does not limit what can be seen. Dropped from the height H it meets the floor at
/// t1 = sqrt(2 H/g) with v1 = sqrt(2 g H), leaves it the k-th time with e^k v1 and rises to
/// e^(2k) H.
struct Bouncing {
    static constexpr double kRestitution = 0.8;
    static constexpr int kBounces = 6;  ///< the last one at some 2.9 s

    double top;  ///< of the fall before the first bounce [m]
    double v1 = std::sqrt(2 * kGravity * top), exact_time = v1 / kGravity;
    double before = 0;  ///< velocity after the last step [m/s]
    int count = 0;
    double height_error = 0, time_error = 0;

    void see(double time, double y, double v) {
        if (count < kBounces && v > 0 && before <= 0) {
            ++count;
            const double rise = v * v + 2 * kGravity * y;
            const double left = time - (std::sqrt(rise) - v) / kGravity;
            const double exact_height = std::pow(kRestitution, 2 * count) * top;
            height_error =
                std::max(height_error, std::abs(rise / (2 * kGravity) / exact_height - 1));
            time_error = std::max(time_error, std::abs(left - exact_time));
            exact_time += 2 * std::pow(kRestitution, count) * v1 / kGravity;
        }
        before = v;
    }
};

}  // namespace

Experiment bounces(const Knobs& knobs) {
    const auto settings = settings_of(3.2, knobs, kDown);
    const auto height = [](int copy) { return 1 + 0.01 * copy; };
    Bodies bodies = floor_of(0, 0);
    for (int i = 0; i < kCopies; ++i)
        add(bodies, sphere_type(kRadius, 2, 0, Bouncing::kRestitution),
            place(i) + Vec4(0, kRadius + height(i), 0, 0));
    return {"bounces", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                std::vector<Bouncing> spheres;
                for (int i = 0; i < kCopies; ++i) spheres.push_back({height(i)});
                const Bodies& now = trial.bodies();
                trial.run([&](double time, const StepReport&) {
                    for (std::size_t i = 0; i < kCopies; ++i)
                        spheres[i].see(time, now.position[i + 1][1] - kRadius,
                                       now.velocity[i + 1][1]);
                });
                double height_error = 0, time_error = 0;
                for (const Bouncing& s : spheres) {
                    if (s.count < Bouncing::kBounces) throw RunError("a bounce is missing");
                    height_error = std::max(height_error, s.height_error);
                    time_error = std::max(time_error, s.time_error);
                }
                return {{"height", "relative", height_error}, {"bounce time", "s", time_error}};
            }};
}

/// Slip starts at v0 and falls by mu g (1 + 3) a second, so that the sphere slides for
/// t = v0/(4 mu g) and then rolls at 3/4 v0.
Experiment sliding_to_rolling(const Knobs& knobs) {
    const double mu = 0.3;
    const auto settings = settings_of(1, knobs, kDown);
    const auto start_speed = [](int copy) { return 3.6 + 0.0371 * copy; };
    Bodies bodies = floor_of(mu, 0);
    for (int i = 0; i < kCopies; ++i)
        add(bodies, sphere_type(kRadius, 2, mu, 0), place(i) + Vec4(0, kRadius, 0, 0),
            {start_speed(i), 0, 0, 0});
    return {"sliding_to_rolling", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                double speed_error = 0, distance_error = 0;
                for (int i = 0; i < kCopies; ++i) {
                    const auto id = static_cast<std::size_t>(i + 1);
                    const double v0 = start_speed(i), t = v0 / (4 * mu * kGravity);
                    const double distance =
                        v0 * t - 0.5 * mu * kGravity * t * t + 0.75 * v0 * (settings.duration - t);
                    const Bodies& now = trial.bodies();
                    speed_error = std::max(speed_error, std::abs(now.velocity[id][0] - 0.75 * v0));
                    distance_error =
                        std::max(distance_error, std::abs(now.position[id][0] - distance));
                }
                return {{"speed", "m/s", speed_error}, {"distance", "m", distance_error}};
            }};
}

/// Rolls at 3/4 g sin(angle), since mu > tan(angle) / 4.
Experiment rolling_down(const Knobs& knobs) {
    const double angle = 20 * pi / 180;
    const auto settings =
        settings_of(1, knobs, {kGravity * std::sin(angle), -kGravity * std::cos(angle), 0, 0});
    Bodies bodies = floor_of(0.6, 0);
    add(bodies, sphere_type(kRadius, 2, 0.6, 0), {0, kRadius, 0, 0});
    return {"rolling_down", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                const Bodies& now = trial.bodies();
                const double exact = 0.75 * kGravity * std::sin(angle);
                return {{"speed", "m/s", std::abs(now.velocity[1][0] - exact)},
                        {"distance", "m", std::abs(now.position[1][0] - 0.5 * exact)}};
            }};
}

/// Ten equal spheres at rest, whose lowest contact carries all. Rigid ones would not sink.
Experiment column_of_spheres(const Knobs& knobs) {
    constexpr int kCount = 10;
    constexpr double kMass = 2;
    const auto settings = settings_of(0.5, knobs, kDown);
    Bodies bodies = floor_of(0.5, 0);
    bodies.types.push_back(sphere_type(kRadius, kMass, 0.5, 0));
    for (int i = 0; i < kCount; ++i) add(bodies, 1u, {0, (2 * i + 1) * kRadius, 0, 0});
    return {"column_of_spheres", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                double overlap = 0;
                trial.run([&](double, const StepReport&) {
                    const double top = trial.bodies().position[kCount][1];
                    overlap = std::max(overlap, std::abs((2 * kCount - 1) * kRadius - top));
                });
                const double impulse = trial.memory().impulses[0].normal;  // of one sub-step
                const double force = impulse * settings.substeps * settings.steps_per_second;
                return {{"force on the floor", "relative",
                         std::abs(force / (kCount * kMass * kGravity) - 1)},
                        {"height of the top", "m", overlap}};
            }};
}

}  // namespace tesserae::bench
