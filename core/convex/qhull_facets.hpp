#pragma once

#include <cstddef>
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

}  // namespace tesserae
