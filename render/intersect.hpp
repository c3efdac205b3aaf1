#pragma once

#include <cstdint>

#include "render/picture.hpp"
#include "render/placed_bodies.hpp"

namespace tesserae::render {

/// How far a ray travels before it enters a body.
/// @param origin      relative to the camera, world axes [m]
/// @param direction   unit, world axes
/// @return distance >= 0 [m], 0 if the origin lies in the body; kMiss if it is missed or farther
///         than `limit`
/// A pure function of ray and body. kAnalytic is the room's closed form. kTrace is sphere tracing
/// in the body's frame from where the ray enters the body's bounding sphere: see `trace`.
double hit_distance(const PlacedBodies& placed, std::uint32_t body, const Vec4& origin,
                    const Vec4& direction, double limit, const Settings& settings,
                    FrameStats& stats);

struct Hit {
    double distance = kMiss;
    std::uint32_t body = ~std::uint32_t{0};  ///< index into PlacedBodies::bodies

    explicit operator bool() const { return distance < kMiss; }
};

}  // namespace tesserae::render
