// SPDX-License-Identifier: Apache-2.0
// One to four bodies thrown into a wedge between two walls, with friction of 0.5 to 3.

#include <algorithm>
#include <cmath>

#include "bench/gate/gate.hpp"
#include "bench/gate/watch.hpp"

namespace tesserae::bench::gate {
namespace {

constexpr double kSlit = 0.1;  ///< half the width between the walls at y = 0 [m]
constexpr double kSeconds = 3;
constexpr double kGain = 0.01;  ///< of the largest kinetic energy: more is counted

std::vector<double> measure(const Run& run) {
    std::mt19937_64 engine(3000 + static_cast<std::uint64_t>(run.scene));
    const auto part = [&](double least, double most) {
        return testing::uniform(engine, least, most);
    };
    const double lean = part(5, 30) * pi / 180, friction = drawn_decade(engine, 0.5, 3);
    const double restitution = run.scene % 2 == 0 ? 0 : 0.3;
    Bodies bodies;
    std::vector<Vec4> inward;
    for (const double side : {-1.0, 1.0})
        inward.push_back({side * std::cos(lean), std::sin(lean), 0, 0});
    for (const Vec4& normal : inward)
        add(bodies, plane_type(normal, -kSlit * std::cos(lean), friction, restitution));
    add_walls(bodies, {2, 3}, 0.7, friction, restitution);

    const int count = 1 + static_cast<int>(engine() % 4);
    double smallest = 1, y = 0.3;
    for (int i = 0; i < count; ++i) {
        BodyType type = drawn_type(engine, static_cast<int>(engine() % kShapes), part(0.3, 0.6));
        type.mass *= drawn_decade(engine, 0.3, 3);
        type.friction = friction, type.restitution = restitution;
        smallest = std::min(smallest, 2 * half_thickness(type.shape));
        const double radius = bounding_radius(type.shape);
        // As high as it fits between the walls, and above the one before.
        y = std::max(y + radius, (1.1 * radius / std::cos(lean) - kSlit) / std::tan(lean));
        Vec4 place = random_vector(engine, 0.1);
        place[0] = 0, place[1] = y;
        y += radius + 0.05;
        add(bodies, type, place, -part(0, 10) * Vec4::UnitY() + random_vector(engine, 0.5),
            drawn_plane(engine, 5), drawn_rotor(engine));
    }
    shake(bodies, run.shake);
    Stepper world(bodies, gravity_of_10());
    const Watched seen = watch(world, kSeconds);
    bool out = false;
    for (BodyId id = 0; id < bodies.size(); ++id)
        for (const Vec4& normal : inward)
            out |= bodies.is_movable(id) &&
                   normal.dot(world.bodies().position[id]) < -kSlit * std::cos(lean);
    return {
        100 * seen.gain,         static_cast<double>(seen.gain > kGain), 1e3 * seen.last_fastest,
        seen.deepest / smallest, seen.last_deepest / smallest,           static_cast<double>(out)};
}

}  // namespace

std::vector<Family> jam_families() {
    return {{"jams",
             40,
             16,
             2,
             {spread_of("largest gain of energy", "%"), count_of("gained more than 1 %"),
              spread_of("fastest in the last second", "mm/s"),
              spread_of("deepest overlap", "of the smallest"),
              spread_of("overlap at the end", "of the smallest"), count_of("a body squeezed out")},
             measure}};
}

}  // namespace tesserae::bench::gate
