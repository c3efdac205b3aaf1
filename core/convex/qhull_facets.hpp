// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/convex/hull.hpp"

namespace tesserae {

/// QhullFacets is what Qhull finds of a hull. It is empty if the points are flat. If there are more
/// than kMostVertices, it may be the hull of only some of the points.
struct QhullFacets {
    std::vector<std::size_t> vertices;  ///< numbers of the points that are vertices, ascending
    std::vector<HalfSpace> planes;      ///< of the facets; several may be about the same
};

/// Returns the convex hull of points.
QhullFacets qhull_facets(const std::vector<Vec4>& points);

/// Returns the polygons of the convex hull of points in three dimensions, each by the places of its
/// corners among the points, counter-clockwise seen from outside. Points that are in one plane to
/// rounding make one polygon. The result is empty if all points are in one plane, to rounding.
std::vector<std::vector<std::uint32_t>> qhull_polygons(std::vector<Eigen::Vector3d> points);

}  // namespace tesserae
