// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/algebra/vector.hpp"
#include "core/shape/room.hpp"

namespace tesserae::render {

/// The index of no body.
constexpr std::uint32_t kNoBody = ~std::uint32_t{0};

/// A ray in any direction of 4D.
struct Ray {
    Vec4 origin;     ///< relative to the camera, world axes [m]
    Vec4 direction;  ///< unit, world axes
    /// The body left out, or kNoBody: a ray that leaves a convex body outward never meets it again,
    /// so that no origin needs to be moved off its surface.
    std::uint32_t on = kNoBody;
    double limit = kMiss;  ///< what is farther than this does not count [m]
    double time = 0;       ///< since the shutter opened [s]

    Vec4 at(double distance) const { return origin + distance * direction; }
};

/// The first body that a ray meets: the nearest, and of equally near ones that of the lowest index.
struct Hit {
    double distance = kMiss;
    std::uint32_t body = kNoBody;  ///< index into PlacedBodies::bodies

    explicit operator bool() const { return distance < kMiss; }

    /// Takes a body that the ray meets at a distance (kMiss: not at all) if it comes before the one
    /// that is held. Bodies may come in any order. Returns whether it was taken.
    bool take(std::uint32_t other, double at) {
        const bool is_first = at < distance || (at == distance && at < kMiss && other < body);
        if (is_first) *this = {at, other};
        return is_first;
    }
};

/// The directions within an angle (possibly negative) of an axis, from an apex.
struct Cone {
    double sine, cosine;  ///< of the half-angle, within +-90 degrees
};

}  // namespace tesserae::render
