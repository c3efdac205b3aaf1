// SPDX-License-Identifier: Apache-2.0
// Two to four bodies of any shape that meet in the air, with restitution 0, 0.5 or 1, with and
// without friction.

#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/gate/gate.hpp"
#include "bench/gate/watch.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "core/dynamics/diagnostics/momentum.hpp"

namespace tesserae::bench::gate {
namespace {

constexpr double kSeconds = 1;
constexpr double kGain = 1e-3;  ///< of the energy at the start: more is counted
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A body at rest in the middle, and others on their way to it.
Bodies drawn_group(int scene) {
    std::mt19937_64 engine(4000 + static_cast<std::uint64_t>(scene));
    const double restitution = 0.5 * (scene % 3), friction = scene / 3 % 2 == 0 ? 0 : 0.5;
    const int count = scene % 5 < 3 ? 2 : 2 + static_cast<int>(engine() % 3);
    Bodies bodies;
    double reach = 0;
    for (int i = 0; i < count; ++i) {
        BodyType type = drawn_type(engine, static_cast<int>(engine() % kShapes),
                                   testing::uniform(engine, 0.2, 0.6));
        type.mass = drawn_decade(engine, 0.1, 10);
        type.friction = friction, type.restitution = restitution;
        const Vec4 towards = random_vector(engine, 1).normalized();
        const double radius = bounding_radius(type.shape);
        const Vec4 place = -(reach + 1.01 * radius) * towards + random_vector(engine, 0.2 * radius);
        if (i == 0) {
            reach = 1.3 * radius;
            add(bodies, type, Vec4::Zero(), Vec4::Zero(), drawn_plane(engine, 3),
                drawn_rotor(engine));
        } else {
            add(bodies, type, place, testing::uniform(engine, 1, 5) * towards,
                drawn_plane(engine, 5), drawn_rotor(engine));
            reach += 2.1 * radius;
        }
    }
    return bodies;
}

std::vector<double> measure(const Run& run) {
    Bodies bodies = drawn_group(run.scene);
    shake(bodies, run.shake);
    PhysicsSettings settings;
    settings.gravity.setZero();
    Stepper world(bodies, settings);
    const double energy = kinetic_energy(bodies);
    const Vec4 momentum = total_momentum(bodies);
    const Bivector angular = total_angular_momentum(bodies);
    double amount = 0, smallest = 1;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        amount += bodies.type_of(id).mass * bodies.velocity[id].norm();
        smallest = std::min(smallest, 2 * half_thickness(bodies.type_of(id).shape));
    }
    const double deepest = watch(world, kSeconds).deepest;
    const Bodies& now = world.bodies();
    const double change = kinetic_energy(now) / energy - 1;
    const bool elastic = run.scene % 6 == 2;  // restitution 1 and no friction
    return {elastic ? 100 * std::abs(change) : kNone,
            elastic ? kNone : 100 * std::max(0.0, change),
            static_cast<double>(change > kGain),
            (total_momentum(now) - momentum).norm() / amount,
            norm(total_angular_momentum(now) - angular) / amount,
            deepest / smallest};
}

}  // namespace

std::vector<Family> impact_families() {
    return {{"impacts",
             200,
             80,
             2,
             {spread_of("energy changed, restitution 1, no friction", "%"),
              {"energy gained, all others", "%", {Statistic::kNinth}},
              count_of("gained more than 0.1 %"),
              {"momentum changed", "of the sum of its parts", {Statistic::kNinth}},
              {"angular momentum changed", "of the sum of its parts a m", {Statistic::kNinth}},
              spread_of("deepest overlap", "of the smallest")},
             measure}};
}

}  // namespace tesserae::bench::gate
