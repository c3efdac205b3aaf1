// SPDX-License-Identifier: Apache-2.0
#include "render/scene/placed_bodies.hpp"

namespace tesserae::render {

PlacedBodies place_bodies(const Picture& picture, const Vec4& origin, const ShutterPart& part) {
    const Bodies& bodies = picture.bodies;
    PlacedBodies placed;
    placed.motions = part.motions;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const std::uint32_t type = bodies.type[id];
        if (!picture.appearance[type].visible) continue;
        const Shape& shape = bodies.types[type].shape;
        const std::uint32_t motion = part.motions ? part.motions->of(id) : Motions::kStill;
        if (motion != Motions::kStill) {
            const Motions::Sweep sweep = part.motions->sweep(motion, part.begin, part.end);
            placed.bodies.push_back(
                {sweep.centre, sweep.radius, &shape, id, PlacedBody::kNotTurned, motion});
            continue;
        }
        std::uint32_t turn = PlacedBody::kNotTurned;
        if (is_bounded(shape) && looks_turned(picture, type)) {
            turn = static_cast<std::uint32_t>(placed.turns.size());
            placed.turns.push_back(to_matrix(bodies.rotor[id]).transpose());
        }
        placed.bodies.push_back(
            {bodies.position[id] - origin, bounding_radius(shape), &shape, id, turn});
    }
    return placed;
}

}  // namespace tesserae::render
