// SPDX-License-Identifier: Apache-2.0
#include "core/shape/hull_shape.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex/convex_separation.hpp"
#include "core/shape/convex_rim.hpp"

namespace tesserae {
namespace {

/// Cells whose planes are so near to the nearest one's, in parts of the size, share a point of the
/// surface.
constexpr double kSameCell = 1e-9;
/// A distance that is a plane's to this part of the lengths involved is that.
constexpr double kPlanes = 5e-16;

const HullBody& body_of(const HullShape& shape) { return *shape.body; }

/// From outside: how far, and where to.
struct Nearest {
    Vec4 normal;
    double distance;
};
Nearest nearest_from(const HullBody& body, const Vec4& point, const LinearForms::Largest& plane) {
    // In a unit whose squares are numbers.
    const double unit = std::max(body.radius, stable_norm(point));
    const Vec4 seen = point / unit;
    const auto corner = [&](const Vec4& direction) -> Vec4 {
        return body.hull.vertices[body.corners.largest_at(direction).number] / unit;
    };
    const auto there = [&](const Vec4&) -> Vec4 { return seen; };
    const ConvexSeparation nearest = separation_of(corner, there, seen, 2);
    // Over the cell: its plane's distance is the exact one.
    if (unit * nearest.distance - plane.value <= kPlanes * unit)
        return {body.hull.cells[plane.number].plane.normal, plane.value};
    return {nearest.normal, unit * nearest.distance};
}

}  // namespace

HullBody::HullBody(Hull of) : hull(std::move(of)) {
    for (const Vec4& vertex : hull.vertices) {
        corners.add(vertex, 0);
        radius = std::max(radius, stable_norm(vertex));
    }
    for (const HullCell& cell : hull.cells) {
        planes.add(cell.plane.normal, cell.plane.offset);
        normals.add(cell.plane.normal, 0);
    }
    axes = principal_axes(hull.mean_square);
}

double volume(const HullShape& shape) { return body_of(shape).hull.content; }

Vec4 second_moments(const HullShape& shape, double mass) {
    const HullBody& body = body_of(shape);
    return mass * body.hull.size * body.hull.size * body.axes.moments;
}

const Rotor* principal_axes(const HullShape& shape) {
    const PrincipalAxes& axes = body_of(shape).axes;
    return axes.are_given ? nullptr : &axes.axes;
}

double bounding_radius(const HullShape& shape) { return body_of(shape).radius; }

Vec4 half_extents(const HullShape& shape, const Mat4& rotation) {
    Vec4 half = Vec4::Zero();
    for (const Vec4& vertex : body_of(shape).hull.vertices)
        half = half.cwiseMax((rotation * vertex).cwiseAbs());
    return half;
}

double half_extent_along(const HullShape& shape, const Vec4& direction) {
    const LinearForms& corners = body_of(shape).corners;
    return std::max(corners.largest_at(direction).value, corners.largest_at(-direction).value);
}

bool is_face_normal(const HullShape& shape, const Vec4& direction) {
    return (direction - face_along(shape, direction).normal).norm() <= kFaceNormal;
}

Face face_along(const HullShape& shape, const Vec4& direction) {
    const HullBody& body = body_of(shape);
    const HalfSpace& plane = body.hull.cells[body.normals.largest_at(direction).number].plane;
    return {plane.normal, plane.offset};
}

std::uint64_t faces_near(const HullShape& shape, const Vec4& point, double depth) {
    const std::vector<HullCell>& cells = body_of(shape).hull.cells;
    if (cells.size() > 64) return ~std::uint64_t{0};
    std::uint64_t faces = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const HalfSpace& plane = cells[i].plane;
        faces |= std::uint64_t{plane.offset - plane.normal.dot(point) <= depth} << i;
    }
    return faces;
}

Vec4 support(const HullShape& shape, const Vec4& direction) {
    const HullBody& body = body_of(shape);
    return body.hull.vertices[body.corners.largest_at(direction).number];
}

double signed_distance(const HullShape& shape, const Vec4& point) {
    const HullBody& body = body_of(shape);
    const LinearForms::Largest plane = body.planes.largest_at(point);
    return plane.value <= 0 ? plane.value : nearest_from(body, point, plane).distance;
}

/// Inside the nearest cell's; of several equally near ones the first's.
Vec4 normal(const HullShape& shape, const Vec4& point) {
    const HullBody& body = body_of(shape);
    const LinearForms::Largest plane = body.planes.largest_at(point);
    if (plane.value > 0) return nearest_from(body, point, plane).normal;
    return body.hull.cells[plane.number].plane.normal;
}

Vec4 shading_normal(const HullShape& shape, const Vec4& point) {
    const HullBody& body = body_of(shape);
    const double deepest = body.planes.largest_at(point).value;
    Vec4 sum = Vec4::Zero();
    for (const HullCell& cell : body.hull.cells)
        if (cell.plane.normal.dot(point) - cell.plane.offset >= deepest - kSameCell * body.radius)
            sum += cell.plane.normal;
    // Of a slab as thin as that they cancel.
    return sum.norm() > 1e-3 ? sum.normalized() : normal(shape, point);
}

std::size_t shared_bytes(const HullShape& shape) {
    const Hull& hull = body_of(shape).hull;
    // Vertices twice, planes three times.
    std::size_t bytes = sizeof(HullBody) + 72 * hull.vertices.size();
    for (const HullCell& cell : hull.cells)
        bytes += sizeof(HullCell) + 80 + 2 * cell.vertices.size() + 4 * cell.edges.size() +
                 sizeof(HalfSpace) * cell.sides.size();
    return bytes;
}

double ray_hit(const HullShape& shape, const Vec4& origin, const Vec4& direction) {
    const LinearForms::Interval inside = body_of(shape).planes.not_positive_on(origin, direction);
    if (!(inside.enter <= inside.leave) || inside.leave < 0) return kMiss;
    return std::max(0.0, inside.enter);
}

double ray_exit(const HullShape& shape, const Vec4& origin, const Vec4& direction) {
    return std::max(0.0, body_of(shape).planes.not_positive_on(origin, direction).leave);
}

Level quick_level(const HullShape& shape, const Vec4& point) {
    const HullBody& body = body_of(shape);
    const LinearForms::Largest plane = body.planes.largest_at(point);
    return {plane.value, body.hull.cells[plane.number].plane.normal};
}

Rim rim(const HullShape& shape, const Vec4& origin, const Vec4& direction, const RimRange& range) {
    const LinearForms::Interval met = body_of(shape).planes.not_positive_on(origin, direction);
    if (const auto known = rim_by_interval({met.enter, met.leave},
                                           bounding_radius(shape) + stable_norm(origin), range))
        return *known;
    return convex_rim(shape, origin, direction, range);
}

}  // namespace tesserae
