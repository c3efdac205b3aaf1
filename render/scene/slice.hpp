// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/camera/camera.hpp"
#include "render/scene/placed_bodies.hpp"

namespace tesserae::render {

/// What a view ray can meet of a body: a sphere and a box that hold its slices by the camera's
/// hyperplane, and the film rectangle that holds their picture from the pinhole. Rounded outward.
/// An unbounded body has an infinite radius, box and rectangle.
struct SliceBounds {
    Vec3 centre;            ///< camera coordinates [m]
    double radius;          ///< [m]
    Vec3 low, high;         ///< of the box, camera coordinates [m]
    double nearest;         ///< no ray from the pinhole meets the body before this distance [m]
    double x0, y0, x1, y1;  ///< film points, closed
    std::uint32_t body;     ///< index into PlacedBodies::bodies
};

/// Of one body; nothing where no view ray can meet it.
/// @param index, range   as in slice_bounds()
std::optional<SliceBounds> slice_bounds_of(const PlacedBodies& placed, std::uint32_t index,
                                           const Camera& camera, double max_distance,
                                           const SliceRange& range);

/// The bodies that the camera's hyperplane cuts anywhere in `range`, in front of the camera and
/// within max_distance [m] of it, ascending by body. A body whose extent along the fourth axis
/// misses the range is left out. Made on the threads of the caller's task arena.
std::vector<SliceBounds> slice_bounds(const PlacedBodies& placed, const Camera& camera,
                                      double max_distance, const SliceRange& range = {});

}  // namespace tesserae::render
