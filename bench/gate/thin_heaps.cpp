// SPDX-License-Identifier: Apache-2.0
// A dozen plates, rods and coins of 3 to 15 mm, of unequal masses, that fall into a pit.

#include <algorithm>
#include <cmath>

#include "bench/gate/gate.hpp"
#include "bench/gate/watch.hpp"
#include "bench/resting_scenes.hpp"

namespace tesserae::bench::gate {
namespace {

constexpr int kCount = 12;
constexpr double kPit = 0.4;  ///< half its width [m]
constexpr double kSeconds = 4;
constexpr double kGain = 0.01;  ///< of the largest kinetic energy: more is counted

std::vector<double> measure(const Run& run) {
    std::mt19937_64 engine(2000 + static_cast<std::uint64_t>(run.scene));
    Bodies bodies = floor_and();
    add_walls(bodies, {0, 2, 3}, kPit, 0.5);
    double thinnest = 1;
    for (int i = 0; i < kCount; ++i) {
        const double thickness = drawn_decade(engine, 0.003, 0.015);
        BodyType type = thin_type(static_cast<int>(engine() % kThinShapes),
                                  testing::uniform(engine, 0.2, 0.5), thickness);
        type.mass = drawn_decade(engine, 0.1, 10);
        thinnest = std::min(thinnest, thickness);
        Vec4 place = random_vector(engine, 0.1);
        place[1] = 0.4 + 0.4 * i;
        add(bodies, type, place, -Vec4::UnitY(), drawn_plane(engine, 2), drawn_rotor(engine));
    }
    shake(bodies, run.shake);
    Stepper world(bodies, gravity_of_10());
    const Watched seen = watch(world, kSeconds);
    bool out = false;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        if (!bodies.is_movable(id)) continue;
        const Vec4& x = world.bodies().position[id];
        out |= x[1] < 0;
        for (const int axis : {0, 2, 3}) out |= std::abs(x[axis]) > kPit;
    }
    return {
        seen.deepest / thinnest, seen.last_deepest / thinnest,           1e3 * seen.last_fastest,
        100 * seen.gain,         static_cast<double>(seen.gain > kGain), static_cast<double>(out)};
}

}  // namespace

std::vector<Family> thin_heap_families() {
    return {
        {"thin heaps",
         40,
         8,
         2,
         {spread_of("deepest overlap", "of the thinnest"),
          spread_of("overlap at the end", "of the thinnest"),
          spread_of("fastest in the last second", "mm/s"), spread_of("largest gain of energy", "%"),
          count_of("gained more than 1 %"), count_of("a body squeezed out")},
         measure}};
}

}  // namespace tesserae::bench::gate
