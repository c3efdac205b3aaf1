// SPDX-License-Identifier: Apache-2.0
// Stacks of boards, a wall and a pyramid of boxes, 1, 10 and 30 s after they were put up.

#include <algorithm>
#include <random>

#include "bench/bodies.hpp"
#include "bench/gate/gate.hpp"
#include "bench/gate/watch.hpp"
#include "bench/peers/engine.hpp"

namespace tesserae::bench::gate {
namespace {

constexpr double kLooks[] = {1, 10, 30};  ///< [s]
constexpr double kWatched = 0.5;          ///< before each of them [s]

/// Positions of a scene, shaken as shake() does bodies.
PeerScene shaken(PeerScene scene, std::uint64_t shake) {
    if (shake == 0) return scene;
    std::mt19937_64 engine(shake);
    for (Vec4& position : scene.position) position += random_vector(engine, 1e-9);
    return scene;
}

std::vector<double> measure(const PeerScene& of, const Run& run) {
    const PeerScene scene = shaken(of, run.shake);
    const std::unique_ptr<PeerEngine> engine = make_tesserae_with(scene, PhysicsSettings{});
    std::vector<double> values;
    std::vector<Vec4> last = scene.position;
    double time = 0;
    for (const double look : kLooks) {
        double fastest = 0, overlap = 0, moved = 0;
        for (; time < look - 0.5 * kPeerStep; time += kPeerStep) {
            engine->step();
            if (time < look - kWatched - kPeerStep) continue;
            const std::vector<Vec4> now = engine->positions();
            if (time >= look - kWatched)
                for (std::size_t i = 0; i < now.size(); ++i)
                    fastest = std::max(fastest, (now[i] - last[i]).norm() / kPeerStep);
            overlap = engine->penetration();
            last = now;
        }
        for (std::size_t i = 0; i < last.size(); ++i)
            moved = std::max(moved, (last[i] - scene.position[i]).norm());
        values.insert(values.end(), {1e3 * fastest, 1e3 * overlap, 1e3 * moved});
    }
    return values;
}

Family family_of(const PeerScene& scene, const std::string& name) {
    Family family;
    family.name = name;
    family.runs = 3;
    for (const double look : kLooks) {
        const std::string at = ", " + std::to_string(static_cast<int>(look)) + " s";
        family.quantities.push_back({"fastest" + at, "mm/s"});
        family.quantities.push_back({"overlap" + at, "mm"});
        family.quantities.push_back({"moved" + at, "mm"});
    }
    family.measure = [scene](const Run& run) { return measure(scene, run); };
    return family;
}

}  // namespace

std::vector<Family> rest_families() {
    return {family_of(box_wall(4, 140), "rest: wall of 140 boxes"),
            family_of(box_pyramid(4, 105), "rest: pyramid of 105 boxes"),
            family_of(board_stacks(4, 30), "rest: three stacks of ten boards")};
}

}  // namespace tesserae::bench::gate
