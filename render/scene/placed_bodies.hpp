// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "render/picture.hpp"
#include "render/scene/motions.hpp"

namespace tesserae::render {

/// The radius of what has no bounds [m].
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A visible body as rays see it. World axes, origin at the camera, so that a scene far from the
/// world's origin loses no digits.
struct PlacedBody {
    static constexpr std::uint32_t kNotTurned = ~std::uint32_t{0};

    /// Of the body's frame [m]; a hyperplane's frame is the world. Of a body that moves, with the
    /// radius: a ball that holds it all the while.
    Vec4 centre;
    double radius;  ///< of the bounding sphere about it [m]; kInfinite if unbounded
    const Shape* shape;
    BodyId id;
    std::uint32_t turn;  ///< index into PlacedBodies::turns, or kNotTurned
    std::uint32_t motion = Motions::kStill;

    bool moves() const { return motion != Motions::kStill; }
};

/// What the shutter sees of the bodies: all of its opening, or a part of the time from there on.
struct ShutterPart {
    const Motions* motions = nullptr;  ///< none: all stand as they do at the opening
    double begin = 0, end = 0;         ///< since the opening [s]
};

/// All visible bodies, ascending by id, with the rotations that matter: a hypersphere without a
/// pattern is the same in every orientation and has none. Those that move are as they are at a
/// ray's time.
struct PlacedBodies {
    std::vector<PlacedBody> bodies;
    std::vector<Mat4> turns;           ///< world to body
    const Motions* motions = nullptr;  ///< none where nothing moves

    Pose pose(const PlacedBody& b, double time) const { return motions->pose(b.motion, time); }
    Vec4 direction_to_body(const PlacedBody& b, const Vec4& d, double time = 0) const {
        if (b.moves()) [[unlikely]]
            return pose(b, time).turn * d;
        if (b.turn == PlacedBody::kNotTurned) return d;
        return turns[b.turn] * d;
    }
    Vec4 direction_to_world(const PlacedBody& b, const Vec4& d, double time = 0) const {
        if (b.moves()) [[unlikely]]
            return pose(b, time).turn.transpose() * d;
        if (b.turn == PlacedBody::kNotTurned) return d;
        return turns[b.turn].transpose() * d;
    }
    Vec4 point_to_body(const PlacedBody& b, const Vec4& p, double time = 0) const {
        if (b.moves()) [[unlikely]] {
            const Pose at = pose(b, time);
            return at.turn * (p - at.centre);
        }
        return direction_to_body(b, p - b.centre);
    }
};

/// @param origin   the camera's place at the opening
PlacedBodies place_bodies(const Picture& picture, const Vec4& origin, const ShutterPart& part = {});

}  // namespace tesserae::render
