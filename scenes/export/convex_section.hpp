// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shape/shape.hpp"
#include "scenes/export/round_section.hpp"

namespace tesserae::scenes {

/// The section of any convex body, by its support alone: the hull of points of its surface, to
/// which those that are farthest beyond its polygons and edges are added until none is farther than
/// the tolerance [m]. Sharp rims and flat faces come out as such: a body's farthest points are on
/// them. Vertices lie on the surface to rounding.
/// @param tolerance   at least kFinestTolerance of the body's bounding radius
/// @return empty where the slice misses the body, or grazes it in a flat piece
Mesh convex_section(const Shape& shape, const PlacedShape& at, double tolerance);

/// The hull of points as a mesh without those that are not its corners; empty if they are flat.
Mesh hull_mesh(const std::vector<Vec3>& points);

}  // namespace tesserae::scenes
