#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/dynamics/state/bodies.hpp"
#include "render/picture.hpp"

namespace tesserae::render {

/// The radius of what has no bounds [m].
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A visible body as rays see it. World axes, origin at the camera, so that a scene far from the
/// world's origin loses no digits.
struct PlacedBody {
    static constexpr std::uint32_t kNotTurned = ~std::uint32_t{0};

    Vec4 centre;    ///< of the body's frame [m]; a hyperplane's frame is the world
    double radius;  ///< of the bounding sphere about it [m]; kInfinite if unbounded
    const Shape* shape;
    BodyId id;
    std::uint32_t turn;  ///< index into PlacedBodies::turns, or kNotTurned
};

/// All visible bodies, ascending by id, with the rotations that matter: a hypersphere without a
/// pattern is the same in every orientation and has none.
struct PlacedBodies {
    std::vector<PlacedBody> bodies;
    std::vector<Mat4> turns;  ///< world to body

    Vec4 direction_to_body(const PlacedBody& b, const Vec4& d) const {
        if (b.turn == PlacedBody::kNotTurned) return d;
        return turns[b.turn] * d;
    }
    Vec4 direction_to_world(const PlacedBody& b, const Vec4& d) const {
        if (b.turn == PlacedBody::kNotTurned) return d;
        return turns[b.turn].transpose() * d;
    }
    Vec4 point_to_body(const PlacedBody& b, const Vec4& p) const {
        return direction_to_body(b, p - b.centre);
    }
};

/// @param poses   of the picture's bodies at the instant
PlacedBodies place_bodies(const Picture& picture, const Bodies& poses, const Vec4& camera_origin);
inline PlacedBodies place_bodies(const Picture& picture, const Vec4& camera_origin) {
    return place_bodies(picture, picture.bodies, camera_origin);
}

}  // namespace tesserae::render
