#pragma once

#include <cstdint>
#include <memory>

#include "core/convex/hull.hpp"
#include "core/convex/linear_forms.hpp"
#include "core/convex/principal_axes.hpp"
#include "core/shape/room.hpp"

namespace tesserae {

/// What a hull's functions need, made once.
struct HullBody {
    explicit HullBody(Hull hull);

    Hull hull;
    LinearForms corners;  ///< x . vertex
    LinearForms planes;   ///< of the cells
    LinearForms normals;  ///< x . a cell's normal
    double radius = 0;    ///< of the ball about the centre
    PrincipalAxes axes;   ///< of 1 kg and a hull of size 1
};

/// A convex hull of points about its centre of mass: polychora and duoprisms each are one, and
/// their rooms make it.
struct HullShape {
    std::shared_ptr<const HullBody> body;  ///< equal shapes share it
};

double volume(const HullShape& shape);
/// Along its principal axes.
Vec4 second_moments(const HullShape& shape, double mass);
/// What takes them to the body's axes; null if they are those.
const Rotor* principal_axes(const HullShape& shape);
double bounding_radius(const HullShape& shape);
Vec4 half_extents(const HullShape& shape, const Mat4& rotation);
double half_extent_along(const HullShape& shape, const Vec4& direction);
Vec4 support(const HullShape& shape, const Vec4& direction);
double signed_distance(const HullShape& shape, const Vec4& point);
Vec4 normal(const HullShape& shape, const Vec4& point);
double ray_hit(const HullShape& shape, const Vec4& origin, const Vec4& direction);
double ray_exit(const HullShape& shape, const Vec4& origin, const Vec4& direction);
/// Of a point of the surface: the mean of the normals of all cells there. In a slice two cells may
/// be as one, and which of them is nearer is rounding.
Vec4 shading_normal(const HullShape& shape, const Vec4& point);
bool is_face_normal(const HullShape& shape, const Vec4& direction);
Face face_along(const HullShape& shape, const Vec4& direction);
std::uint64_t faces_near(const HullShape& shape, const Vec4& point, double depth);
/// The largest of the cells' planes' distances.
Level quick_level(const HullShape& shape, const Vec4& point);
Rim rim(const HullShape& shape, const Vec4& origin, const Vec4& direction, const RimRange& range);

/// Memory of what equal shapes share.
std::size_t shared_bytes(const HullShape& shape);

}  // namespace tesserae
