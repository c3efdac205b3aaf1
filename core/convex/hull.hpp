// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/algebra/vector.hpp"

namespace tesserae {

/// A HalfSpace is the points with normal . x <= offset.
struct HalfSpace {
    Vec4 normal;  ///< unit
    double offset;
};

/// A HullCell is a flat piece of a hull's boundary: a convex polyhedron in the hyperplane that
/// bounds `plane`.
struct HullCell {
    HalfSpace plane;                                  ///< the half-space that contains the hull
    std::vector<std::uint16_t> vertices;              ///< numbers of its vertices, ascending
    std::vector<std::array<std::uint16_t, 2>> edges;  ///< places of the two ends in `vertices`
    std::vector<HalfSpace> sides;  ///< one for each face; they bound the cell in the hyperplane
};

/// A Hull is a convex polytope in four dimensions.
struct Hull {
    std::vector<Vec4> vertices;   ///< about the centre of mass, in the order of the points [m]
    std::vector<HullCell> cells;  ///< in the order of their vertices
    double content = 0;           ///< [m^4]
    double size = 0;              ///< a length of the order of the hull [m]
    Mat4 mean_square;             ///< mean of x x^T over the hull, in parts of size^2
};

/// Points closer than this part of the hull's size count as one, usual 1e-9. The same holds for
/// planes of cells.
constexpr double kHullAccuracy = 1e-9;
/// A hull is made of at most so many points, and has at most so many vertices and cells.
constexpr std::size_t kMostPoints = 10'000, kMostVertices = 1'000, kMostCells = 4'096;

/// Returns the convex hull of points, by Qhull (Barber, Dobkin and Huhdanpaa 1996). Content, centre
/// and moments are exact: they come from the simplices that join the centre to those of the
/// boundary.
/// @param points   in any order, finite; of equal ones the first counts
/// @throws InputError   too few points, all in one hyperplane, too many points, vertices or cells
Hull hull_of(std::span<const Vec4> points);

}  // namespace tesserae
