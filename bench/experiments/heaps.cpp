// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bench/experiments/experiments.hpp"

// Many bodies on each other. Rigid ones do not overlap, and no step may add energy.
namespace tesserae::bench {
namespace {

constexpr int kSide = 6;  ///< spheres along each axis
constexpr double kMass = 2;

/// Spheres in a cubic lattice, each touching its neighbours on all sides, the lowest the floor, all
/// raised by a height. No friction.
Bodies lattice_of_spheres(double restitution, double height) {
    Bodies bodies = floor_of(0, restitution);
    bodies.types.push_back(sphere_type(kRadius, kMass, 0, restitution));
    for (int y = 0; y < kSide; ++y)
        for (int i = 0; i < kSide * kSide * kSide; ++i)
            add(bodies, 1u,
                {2.0 * kRadius * (i % kSide), (2 * y + 1) * kRadius + height,
                 2.0 * kRadius * (i / kSide % kSide), 2.0 * kRadius * (i / (kSide * kSide))});
    return bodies;
}

}  // namespace

/// At rest from the start. The columns stand on their own (friction and sideways forces are 0), the
/// contact under the n-th sphere from the top carries n weights, and rigid spheres overlap nowhere.
Experiment stacked_spheres(const Knobs& knobs) {
    const auto settings = settings_of(1, knobs, kDown);
    const Bodies bodies = lattice_of_spheres(0, 0);
    return {"stacked_spheres", bodies, settings,
            [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                const Bodies& now = trial.bodies();
                const std::size_t layer = kSide * kSide * kSide;
                double sum = 0, worst = 0;
                for (std::size_t i = 1; i < now.size(); ++i) {
                    const double apart = i <= layer
                                             ? now.position[i][1] + kRadius
                                             : (now.position[i] - now.position[i - layer]).norm();
                    const double overlap = std::max(0.0, 2 * kRadius - apart);
                    sum += overlap;
                    worst = std::max(worst, overlap);
                }
                const double contacts = static_cast<double>(now.size() - 1);
                return {{"mean overlap", "of the radius", sum / contacts / kRadius},
                        {"worst overlap", "of the radius", worst / kRadius}};
            },
            true};
}

/// Falls on the floor from 0.2 m, e = 1: the energy stays. Its unit is what the fall sets free.
Experiment elastic_stack(const Knobs& knobs) {
    constexpr double kHeight = 0.2;
    const auto settings = settings_of(1, knobs, kDown);
    const Bodies bodies = lattice_of_spheres(1, kHeight);
    return {"elastic_stack", bodies, settings,
            [=](Trial& trial) -> std::vector<Error> {
                const double start = energy(bodies, kDown);
                double least = start, most = start;
                trial.run([&](double, const StepReport&) {
                    const double e = energy(trial.bodies(), kDown);
                    least = std::min(least, e);
                    most = std::max(most, e);
                });
                const double count = static_cast<double>(bodies.size() - 1);
                const double freed = count * kMass * kGravity * kHeight;
                return {{"energy lost", "of the fall's", (start - least) / freed},
                        {"energy gained", "of the fall's", (most - start) / freed}};
            },
            true};
}

/// A lattice of 3 x 3 x 3 turned a little at random, over a floor between walls. With e = 0 and
/// friction it comes to rest: neither overlap nor kinetic energy remains, and the energy never
/// rises above that of the start.
Experiment heap_of_capsules(const Knobs& knobs) {
    constexpr double kWall = 1.3;
    const auto settings = settings_of(3, knobs, kDown);
    Bodies bodies = floor_of(0.5, 0);
    add_walls(bodies, {0, 2}, kWall, 0.5);
    add_walls(bodies, {3}, 0.5, 0.5);
    BodyType capsule;
    capsule.shape = Hypercapsule{0.25, 0.5};
    bodies.types.push_back(capsule);
    std::mt19937_64 engine(5);
    std::uniform_real_distribution<> part(-1, 1);
    for (int i = 0; i < 27; ++i) {
        const auto type = static_cast<std::uint32_t>(bodies.types.size() - 1);
        const double x = 0.8 * (i % 3 - 1), z = 0.8 * (i / 3 % 3 - 1), w = 0.1 * part(engine);
        add(bodies, type, {x, 0.6 + 1.1 * (i / 9), z, w});
        Bivector turn;
        for (double* angle : {&turn.xy, &turn.xz, &turn.xw, &turn.yz, &turn.yw, &turn.zw})
            *angle = 0.15 * part(engine);
        bodies.rotor.back() = exp(turn);
    }
    return {"heap_of_capsules", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                const double start = energy(bodies, kDown);
                double most = start, overlap = 0, deepest = 0;
                trial.run([&](double, const StepReport& report) {
                    most = std::max(most, energy(trial.bodies(), kDown));
                    overlap = report.penetration;
                    deepest = std::max(deepest, overlap);
                });
                const double end = energy(trial.bodies(), kDown);
                const double kinetic = energy(trial.bodies(), Vec4::Zero());
                return {
                    {"overlap at the end", "of the radius", overlap / 0.25},
                    {"deepest overlap", "of the radius", deepest / 0.25},
                    {"kinetic energy at the end", "of the fall's", kinetic / (start - end)},
                    {"energy above the start", "of the fall's", (most - start) / (start - end)}};
            }};
}

}  // namespace tesserae::bench
