// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/shape/shape.hpp"
#include "scenes/export/mesh.hpp"

namespace tesserae::scenes {

/// A body's place in the coordinates of a SliceFrame: x_body goes to centre + turn x_body.
struct PlacedShape {
    Vec4 centre = Vec4::Zero();
    Mat4 turn = Mat4::Identity();
};

/// A ball by its centre and radius: a geodesic polyhedron, the faces of an icosahedron divided as
/// finely as the tolerance asks for.
Mesh ball_mesh(const Vec3& centre, double radius, double tolerance);

/// The sections of shapes that are round about an axis: solids of revolution, by rings of regular
/// polygons about it. Flat ends are one polygon each.
Mesh section_mesh(const Hypersphere& shape, const PlacedShape& at, double tolerance);
Mesh section_mesh(const Hypercapsule& shape, const PlacedShape& at, double tolerance);
Mesh section_mesh(const Spherinder& shape, const PlacedShape& at, double tolerance);

// Vertices lie on the surface to rounding and meshes inside the body. No point of either surface is
// farther than the tolerance [m] from the other.

}  // namespace tesserae::scenes
