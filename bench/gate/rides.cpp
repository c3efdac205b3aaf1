// SPDX-License-Identifier: Apache-2.0
// Bodies that slide and roll over a floor of flush boxes, beside the same over one plane.

#include <algorithm>
#include <cmath>

#include "bench/gate/gate.hpp"
#include "bench/gate/watch.hpp"
#include "bench/resting_scenes.hpp"

namespace tesserae::bench::gate {
namespace {

constexpr int kSteps = 240;
constexpr int kLong = 11, kWide = 8, kDeep = 5;  ///< tiles along x, z and w
constexpr double kBefore = 0.8;                  ///< tiles behind the start

BodyType rider(std::mt19937_64& engine, int kind) {
    const double size = testing::uniform(engine, 0.2, 0.4);
    switch (kind) {
        case 0:
            return box_type({1.3 * size, size, size, size}, 1);
        case 1:
            return sphere_type(0.5 * size, 1);
        case 2:
            return box_type({size, 0.1 * size, size, size}, 1);
        default:
            return thin_type(3, size, 0.2 * size);
    }
}

std::vector<double> measure(const Run& run) {
    std::mt19937_64 engine(5000 + static_cast<std::uint64_t>(run.scene));
    const double friction = 0.3 * (run.scene / 4 % 3), tile = testing::uniform(engine, 0.4, 0.8);
    BodyType ground = box_type(Vec4::Constant(tile), 1);
    ground.fixed_position = ground.fixed_rotation = true;
    BodyType body = rider(engine, run.scene % 4);
    ground.friction = body.friction = friction;
    const double height = std::visit(
        [](const auto& s) -> double { return half_extents(s, Mat4::Identity())[1]; }, body.shape);
    const Vec4 way(1, 0, testing::uniform(engine, -0.5, 0.5), testing::uniform(engine, -0.2, 0.2));
    const Vec4 velocity = testing::uniform(engine, 1, 3) * way.normalized();
    const Vec4 place(0, height, tile * testing::uniform(engine, -0.3, 0.3),
                     tile * testing::uniform(engine, -0.3, 0.3));

    Bodies tiles, plane;
    add(plane, plane_type(Vec4::UnitY(), 0, friction));
    tiles.types.push_back(ground);
    for (int i = 0; i < kLong * kWide * kDeep; ++i)
        add(tiles, 0u,
            {tile * (i % kLong - kBefore), -0.5 * tile,
             tile * (i / kLong % kWide - 0.5 * (kWide - 1)),
             tile * (i / kLong / kWide - 0.5 * (kDeep - 1))});
    for (Bodies* bodies : {&tiles, &plane}) add(*bodies, body, place, velocity);
    shake(tiles, run.shake);
    Stepper on_tiles(tiles, gravity_of_10()), on_plane(plane, gravity_of_10());
    double path = 0, hop = 0;
    for (int i = 0; i < kSteps; ++i) {
        on_tiles.step(1 / kDefaultRate), on_plane.step(1 / kDefaultRate);
        Vec4 apart = on_tiles.bodies().position.back() - on_plane.bodies().position.back();
        hop = std::max(hop, std::abs(apart[1]));
        apart[1] = 0;
        path = std::max(path, apart.norm());
    }
    const Vec4 slower = on_tiles.bodies().velocity.back() - on_plane.bodies().velocity.back();
    return {1e3 * path, 1e3 * slower.norm(), 1e3 * hop};
}

}  // namespace

std::vector<Family> ride_families() {
    return {{"rides over seams",
             200,
             48,
             2,
             {spread_of("path differs", "mm"), spread_of("velocity differs", "mm/s"),
              spread_of("hops", "mm")},
             measure}};
}

}  // namespace tesserae::bench::gate
