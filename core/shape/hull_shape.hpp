// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "core/convex/hull.hpp"
#include "core/convex/linear_forms.hpp"
#include "core/convex/principal_axes.hpp"
#include "core/shape/room.hpp"

namespace tesserae {

/// Holds what the functions of a hull need, computed once.
struct HullBody {
    explicit HullBody(Hull hull);

    Hull hull;
    LinearForms corners;  ///< x . vertex, of all vertices
    LinearForms planes;   ///< distance of x from each cell's plane [m]
    LinearForms normals;  ///< x . normal, of all cells
    double radius = 0;    ///< of the ball about the centre of mass [m]
    PrincipalAxes axes;   ///< for a mass of 1 kg and a hull of size 1 m
};

/// A HullShape is the convex hull of points, about its centre of mass. Polychora and duoprisms each
/// are one; their rooms make it.
struct HullShape {
    std::shared_ptr<const HullBody> body;  ///< equal shapes share it
};

double volume(const HullShape& shape);
/// Returns the second moments along the principal axes [kg m^2].
Vec4 second_moments(const HullShape& shape, double mass);
/// Returns the rotor from the principal axes to the body's axes, or null if they are the same.
const Rotor* principal_axes(const HullShape& shape);
double bounding_radius(const HullShape& shape);
Vec4 half_extents(const HullShape& shape, const Mat4& rotation);
double half_extent_along(const HullShape& shape, const Vec4& direction);
Vec4 support(const HullShape& shape, const Vec4& direction);
double signed_distance(const HullShape& shape, const Vec4& point);
Vec4 normal(const HullShape& shape, const Vec4& point);
double ray_hit(const HullShape& shape, const Vec4& origin, const Vec4& direction);
double ray_exit(const HullShape& shape, const Vec4& origin, const Vec4& direction);
/// Returns the mean of the normals of all cells at a point of the surface. In a slice two cells may
/// coincide, and which of them is nearer is rounding.
Vec4 shading_normal(const HullShape& shape, const Vec4& point);
bool is_face_normal(const HullShape& shape, const Vec4& direction);
Face face_along(const HullShape& shape, const Vec4& direction);
std::uint64_t faces_near(const HullShape& shape, const Vec4& point, double depth);
/// Returns the largest signed distance [m] of the point from the planes of the cells.
Level quick_level(const HullShape& shape, const Vec4& point);
Rim rim(const HullShape& shape, const Vec4& origin, const Vec4& direction, const RimRange& range);

/// Returns the bytes of memory that equal shapes share.
std::size_t shared_bytes(const HullShape& shape);

}  // namespace tesserae
