// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/convex/hull.hpp"
#include "scenes/export/mesh.hpp"

namespace tesserae::scenes {

/// A polytope's boundary as a cut goes through it: which edges bound which polygons, and between
/// which two cells each polygon lies.
struct HullFaces {
    struct Face {
        std::array<std::uint32_t, 2> cells;
        std::vector<std::uint32_t> edges;
    };
    std::vector<Vec4> vertices;                       ///< in the body's frame [m]
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< pairs of vertices, ascending
    std::vector<Face> faces;
    std::size_t cells = 0;
};

HullFaces faces_of(const Hull& hull);
/// Of a box with the given full sides, centred.
HullFaces faces_of_box(const Vec4& size);

/// The polyhedron in which a polytope meets the hyperplane where the fourth coordinate is 0. Its
/// vertices lie on the polytope's edges, and each of its polygons in a cell. A vertex that is
/// within kVertexInSlice of the slice lies in it: a cell that only touches the slice from below is
/// its own section.
/// @param placed   the polytope's vertices, in the coordinates of a SliceFrame
/// @return empty where they do not meet in a solid; none if rounding has torn the boundary, which
///         the caller mends with another way to a mesh
std::optional<Mesh> hull_section(const HullFaces& hull, const std::vector<Vec4>& placed);

/// In parts of the polytope's size: more than rounding, less than shows.
constexpr double kVertexInSlice = 1e-12;

}  // namespace tesserae::scenes
