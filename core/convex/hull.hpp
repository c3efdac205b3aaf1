#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/algebra/vector.hpp"

namespace tesserae {

/// The points with normal . x <= offset.
struct HalfSpace {
    Vec4 normal;  ///< unit
    double offset;
};

/// A flat piece of a hull's boundary: a convex polyhedron, in the hyperplane that bounds `plane`.
struct HullCell {
    HalfSpace plane;                                  ///< holds the hull
    std::vector<std::uint16_t> vertices;              ///< ascending
    std::vector<std::array<std::uint16_t, 2>> edges;  ///< by the places of their ends in `vertices`
    std::vector<HalfSpace> sides;  ///< one a face; with the hyperplane they bound it
};

/// A convex polytope in four dimensions.
struct Hull {
    std::vector<Vec4> vertices;   ///< about the centre of mass, in the order of the points [m]
    std::vector<HullCell> cells;  ///< by their vertices, ascending
    double content = 0;           ///< [m^4]
    double size = 0;              ///< a length of its order [m]
    Mat4 mean_square;             ///< of x x^T over it, in parts of size^2
};

/// Points closer than this part of the hull's size are one; so are planes of cells.
constexpr double kHullAccuracy = 1e-9;
constexpr std::size_t kMostPoints = 10'000, kMostVertices = 1'000, kMostCells = 4'096;

/// The convex hull of points, by Qhull (Barber, Dobkin and Huhdanpaa 1996); content, centre and
/// moments exactly, from the simplices that join the centre to the boundary's.
/// @param points   in any order, finite; of equal ones the first counts
/// @throws InputError   too few points, all in one hyperplane, too many points, vertices or cells
Hull hull_of(std::span<const Vec4> points);

}  // namespace tesserae
