#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/convex/hull.hpp"

namespace tesserae {

/// What Qhull finds of a hull; empty where the points are flat. Of more than kMostVertices it may
/// be the hull of some points only.
struct QhullFacets {
    std::vector<std::size_t> vertices;  ///< which points are, ascending
    std::vector<HalfSpace> planes;      ///< several may be about the same
};

QhullFacets qhull_facets(const std::vector<Vec4>& points);

/// The convex hull of points in three dimensions: its polygons, by their corners' places among the
/// points, counter-clockwise seen from outside. Points that are in one plane to rounding make one
/// polygon. Empty where all points are in one plane, to rounding.
std::vector<std::vector<std::uint32_t>> qhull_polygons(std::vector<Eigen::Vector3d> points);

}  // namespace tesserae
