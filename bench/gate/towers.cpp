// SPDX-License-Identifier: Apache-2.0
// Towers of 5 to 40 boxes of unequal sizes, most of them of unequal masses, some with gaps.

#include <algorithm>
#include <cmath>

#include "bench/gate/gate.hpp"
#include "bench/gate/watch.hpp"
#include "bench/resting_scenes.hpp"

namespace tesserae::bench::gate {
namespace {

constexpr double kSeconds = 10;

struct Tower {
    Bodies bodies;  ///< the first is the floor
    double width = 1;
};

Tower drawn_tower(int scene) {
    std::mt19937_64 engine(1000 + static_cast<std::uint64_t>(scene));
    const auto part = [&](double least, double most) {
        return testing::uniform(engine, least, most);
    };
    Tower tower{floor_and(), part(0.4, 1)};
    const int count = 5 + static_cast<int>(engine() % 36);
    const double gap = scene % 2 == 0 ? 0 : drawn_decade(engine, 1e-5, 1e-3);
    // All of one density, then up to 3 and 10 times lighter or heavier.
    const double heavier = scene % 3 == 0 ? 1 : scene % 3 == 1 ? 3 : 10;
    double y = 0;
    for (int i = 0; i < count; ++i) {
        const double w = tower.width;
        const Vec4 size(w * part(0.8, 1.2), w * part(0.5, 1), w * part(0.8, 1.2),
                        w * part(0.8, 1.2));
        Vec4 place = random_vector(engine, 0.02 * w);
        place[1] = y + 0.5 * size[1];
        y += size[1] + gap;
        add(tower.bodies,
            box_type(size, 1000 * size.prod() * drawn_decade(engine, 1 / heavier, heavier)), place);
    }
    return tower;
}

std::vector<double> measure(const Run& run) {
    Tower tower = drawn_tower(run.scene);
    shake(tower.bodies, run.shake);
    Stepper world(tower.bodies, gravity_of_10());
    const Watched seen = watch(world, kSeconds);
    double lean = 0;
    bool fallen = false;
    for (BodyId id = 1; id < tower.bodies.size(); ++id) {
        Vec4 moved = world.bodies().position[id] - tower.bodies.position[id];
        fallen |= -moved[1] > 0.25 * tower.width;
        moved[1] = 0;
        lean = std::max(lean, moved.norm());
    }
    return {1e3 * seen.last_fastest, 1e3 * lean / tower.width, 1e3 * seen.last_deepest,
            static_cast<double>(fallen)};
}

}  // namespace

std::vector<Family> tower_families() {
    return {{"towers",
             60,
             16,
             2,
             {spread_of("fastest in the last second", "mm/s"),
              spread_of("moved aside", "thousandths of the width"),
              spread_of("overlap at the end", "mm"), count_of("fallen")},
             measure}};
}

}  // namespace tesserae::bench::gate
