#pragma once

#include <cstdint>
#include <vector>

#include "render/camera.hpp"
#include "render/placed_bodies.hpp"

namespace tesserae::render {

/// What a view ray can meet of a body: a sphere that holds its slice by the camera's hyperplane,
/// and the film rectangle that holds the sphere's picture. Rounded outward. An unbounded body has
/// an infinite radius and rectangle.
struct SliceBounds {
    Vec3 centre;            ///< camera coordinates [m]
    double radius;          ///< [m]
    double nearest;         ///< no view ray meets the body before this distance [m]
    double x0, y0, x1, y1;  ///< film points, closed
    std::uint32_t body;     ///< index into PlacedBodies::bodies
};

/// The bodies that the camera's hyperplane cuts, in front of the camera and within max_distance
/// [m], ascending by body. A body whose extent along the fourth axis misses the slice is left out.
std::vector<SliceBounds> slice_bounds(const PlacedBodies& placed, const Camera& camera,
                                      double max_distance);

}  // namespace tesserae::render
