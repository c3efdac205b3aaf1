// SPDX-License-Identifier: Apache-2.0
// Coins that are thrown down and wobble, and coins that roll and lean, beside eight times as many
// steps.

#include <algorithm>
#include <cmath>

#include "bench/gate/gate.hpp"
#include "bench/gate/watch.hpp"
#include "bench/resting_scenes.hpp"

namespace tesserae::bench::gate {
namespace {

constexpr int kCoins = 3;
constexpr double kGain = 2e-3;  ///< of the largest kinetic energy: more is counted

/// A spherinder, cubinder or duocylinder of 2 `radius` by `thickness`.
BodyType coin(int kind, double radius, double thickness, double friction) {
    BodyType type = thin_type(3 + kind, 2 * radius, thickness);
    type.friction = friction;
    return type;
}

std::vector<double> thrown(const Run& run) {
    std::mt19937_64 engine(6000 + static_cast<std::uint64_t>(run.scene));
    const double friction = run.scene % 2 ? testing::uniform(engine, 0.1, 0.9) : 0;
    const double thickness = drawn_decade(engine, 1e-3, 0.2);
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, friction));
    add(bodies, coin(run.scene % kCoins, 0.5, thickness, friction), 0.7 * Vec4::UnitY(),
        -Vec4::UnitY(), drawn_plane(engine, 4), drawn_rotor(engine));
    shake(bodies, run.shake);
    Stepper world(bodies, gravity_of_10());
    const Watched seen = watch(world, 1.5);
    return {100 * seen.gain, static_cast<double>(seen.gain > kGain), 1e3 * seen.deepest};
}

/// Its disc in the plane of x and y, leaning in that of y and z, rolling along x.
Bodies rolling(int scene) {
    std::mt19937_64 engine(6500 + static_cast<std::uint64_t>(scene));
    const int kind = scene % kCoins;
    const double radius = drawn_decade(engine, 0.05, 0.5);
    const BodyType type = coin(kind, radius, radius * drawn_decade(engine, 0.02, 0.3),
                               testing::uniform(engine, 0.3, 0.9));
    // A spherinder's ball is in x, z and w: y and z change places.
    Rotor upright;
    if (kind == 0) upright = exp(Bivector{0, 0, 0, pi / 4});
    const double lean = testing::uniform(engine, 0.02, 0.6);
    const Rotor rotor = exp(Bivector{0, 0, 0, 0.5 * lean}) * upright;
    const Vec4 down = to_matrix(rotor).transpose() * -Vec4::UnitY();
    const double height =
        std::visit([&](const auto& s) -> double { return half_extent_along(s, down); }, type.shape);
    const double speed = testing::uniform(engine, 1, 3) * std::sqrt(10 * radius);
    // Such that the point at the bottom is at rest.
    const double along = velocity_at(Bivector{1}, -radius * Vec4::UnitY())[0];
    Bodies bodies;
    add(bodies, plane_type(Vec4::UnitY(), 0, type.friction));
    add(bodies, type, height * Vec4::UnitY(), speed * Vec4::UnitX(), Bivector{-speed / along},
        rotor);
    return bodies;
}

std::vector<double> rolled(const Run& run) {
    constexpr double kSeconds = 1;
    constexpr int kFiner = 8;
    Bodies bodies = rolling(run.scene);
    shake(bodies, run.shake);
    const double radius = bounding_radius(bodies.type_of(1).shape);
    Stepper coarse(bodies, gravity_of_10()), fine(bodies, gravity_of_10());
    const Watched seen = watch(coarse, kSeconds);
    watch(fine, kSeconds, kFiner * kDefaultRate);
    const double apart = (coarse.bodies().position[1] - fine.bodies().position[1]).norm();
    const double turned =
        (to_matrix(coarse.bodies().rotor[1]) - to_matrix(fine.bodies().rotor[1])).norm();
    return {100 * apart / radius, 100 * turned, 100 * seen.gain, 1e3 * seen.deepest / radius};
}

}  // namespace

std::vector<Family> rim_families() {
    return {{"rims, thrown",
             60,
             18,
             2,
             {spread_of("largest gain of energy", "%"), count_of("gained more than 0.2 %"),
              spread_of("deepest overlap", "mm")},
             thrown},
            {"rims, rolling",
             48,
             12,
             2,
             {spread_of("centre differs from small steps", "% of the radius"),
              spread_of("rotation differs from small steps", "%"),
              spread_of("largest gain of energy", "%"),
              spread_of("deepest overlap", "thousandths of the radius")},
             rolled}};
}

}  // namespace tesserae::bench::gate
