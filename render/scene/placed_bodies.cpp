#include "render/scene/placed_bodies.hpp"

namespace tesserae::render {
namespace {

bool has_pattern(const Picture& picture, std::uint32_t type) {
    return picture.materials[picture.appearance[type].material].pattern != Pattern::kNone;
}

}  // namespace

PlacedBodies place_bodies(const Picture& picture, const Bodies& poses, const Vec4& camera_origin) {
    const Bodies& bodies = picture.bodies;
    PlacedBodies placed;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const std::uint32_t type = bodies.type[id];
        if (!picture.appearance[type].visible) continue;
        const Shape& shape = bodies.types[type].shape;
        std::uint32_t turn = PlacedBody::kNotTurned;
        const bool round = std::holds_alternative<Hypersphere>(shape);
        if (is_bounded(shape) && (!round || has_pattern(picture, type))) {
            turn = static_cast<std::uint32_t>(placed.turns.size());
            placed.turns.push_back(to_matrix(poses.rotor[id]).transpose());
        }
        placed.bodies.push_back(
            {poses.position[id] - camera_origin, bounding_radius(shape), &shape, id, turn});
    }
    return placed;
}

}  // namespace tesserae::render
