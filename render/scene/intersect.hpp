// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "render/picture.hpp"
#include "render/ray.hpp"
#include "render/scene/placed_bodies.hpp"

namespace tesserae::render {

/// How far a ray travels before it enters a body.
/// @return distance >= 0 [m], 0 if the origin lies in the body; kMiss if it is missed or farther
///         than the ray's limit
/// A pure function of ray and body. kAnalytic is the room's closed form. kTrace is sphere tracing
/// in the body's frame from where the ray enters the body's bounding sphere: see `trace`.
double hit_distance(const PlacedBodies& placed, std::uint32_t body, const Ray& ray,
                    const Settings& settings, FrameStats& stats);

/// The same in a shape's own frame: of a hypersphere or a hyperbox, the usual ones.
template <class S>
double hit_distance(const S& shape, const Vec4& origin, const Vec4& direction, double limit,
                    const Settings& settings, FrameStats& stats);

}  // namespace tesserae::render
