// SPDX-License-Identifier: Apache-2.0
#include "scenes/export/round_section.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace tesserae::scenes {
namespace {

/// A convex solid of revolution: its radius at the place x along its axis.
struct Revolved {
    Vec3 origin, axis;                     ///< x = 0; unit
    double begin = 0, end = 0;             ///< of x
    std::function<double(double)> radius;  ///< >= 0 in between [m]
};

/// A point of the outline in the half plane about the axis.
struct OutlinePoint {
    double x, radius;
};

/// The outline's points between two that are known, ascending, so that no point of the outline is
/// farther than the tolerance from its polygon. The outline is convex: its distance from a chord
/// has one maximum, where it is split.
void append_outline(const Revolved& solid, const OutlinePoint& from, const OutlinePoint& to,
                    double tolerance, std::vector<OutlinePoint>& points) {
    const double length = std::hypot(to.x - from.x, to.radius - from.radius);
    const auto above = [&](double x) {
        return ((to.x - from.x) * (solid.radius(x) - from.radius) -
                (to.radius - from.radius) * (x - from.x)) /
               length;
    };
    constexpr double kGolden = 0.6180339887498949;
    constexpr int kSearchSteps = 30;
    double a = from.x, b = to.x;
    double u = b - kGolden * (b - a), v = a + kGolden * (b - a), at_u = above(u), at_v = above(v);
    for (int i = 0; i < kSearchSteps; ++i) {
        if (at_u > at_v) {
            b = v, v = u, at_v = at_u;
            u = b - kGolden * (b - a), at_u = above(u);
        } else {
            a = u, u = v, at_u = at_v;
            v = a + kGolden * (b - a), at_v = above(v);
        }
    }
    // A chord that rounding has left without a middle is short enough.
    if (std::max(at_u, at_v) > tolerance && from.x < u && u < to.x) {
        const OutlinePoint middle = {u, solid.radius(u)};
        append_outline(solid, from, middle, tolerance, points);
        append_outline(solid, middle, to, tolerance, points);
    } else {
        points.push_back(to);
    }
}

/// Sides of the rings: the largest keeps half of the tolerance.
std::uint32_t ring_sides(const std::vector<OutlinePoint>& outline, double tolerance) {
    double largest = 0;
    for (const OutlinePoint& p : outline) largest = std::max(largest, p.radius);
    constexpr double kFewest = 3, kMost = 100'000;
    const double cosine = 1 - std::min(1.0, tolerance / largest);
    return static_cast<std::uint32_t>(
        std::clamp(std::ceil(std::numbers::pi / std::acos(cosine)), kFewest, kMost));
}

/// An outline's end: below this part of the tolerance a ring is a point. Far above what rounding
/// leaves of a pole's radius, the square root of its rounding.
constexpr double kPointRadius = 1e-3;

/// Rings about the axis, and quadrilaterals between them.
Mesh revolved_mesh(const Revolved& solid, double tolerance) {
    std::vector<OutlinePoint> outline = {{solid.begin, solid.radius(solid.begin)}};
    append_outline(solid, outline[0], {solid.end, solid.radius(solid.end)}, 0.5 * tolerance,
                   outline);
    const std::uint32_t sides = ring_sides(outline, 0.5 * tolerance);
    const Vec3 across = solid.axis.unitOrthogonal(), third = solid.axis.cross(across);

    Mesh mesh;
    struct Ring {
        std::uint32_t first;
        bool is_point;
        std::uint32_t corner(std::uint32_t i) const { return is_point ? first : first + i; }
    };
    std::vector<Ring> rings;
    for (const OutlinePoint& p : outline) {
        const bool is_end = &p == &outline.front() || &p == &outline.back();
        const bool is_point = is_end && p.radius <= kPointRadius * tolerance;
        rings.push_back({static_cast<std::uint32_t>(mesh.vertices.size()), is_point});
        for (std::uint32_t i = 0; i < (is_point ? 1 : sides); ++i) {
            const double angle = 2 * std::numbers::pi * i / sides;
            const double radius = is_point ? 0 : p.radius;
            mesh.vertices.push_back(solid.origin + p.x * solid.axis +
                                    radius * (std::cos(angle) * across + std::sin(angle) * third));
        }
    }
    // The flat ends, the first against the axis.
    for (const bool at_end : {false, true}) {
        const Ring& ring = at_end ? rings.back() : rings.front();
        if (ring.is_point) continue;
        std::vector<std::uint32_t> disc;
        for (std::uint32_t i = 0; i < sides; ++i)
            disc.push_back(ring.corner(at_end ? i : sides - 1 - i));
        mesh.add_face(disc);
    }
    for (std::size_t r = 0; r + 1 < rings.size(); ++r)
        for (std::uint32_t i = 0, j = 1; i < sides; ++i, j = (i + 1) % sides) {
            std::vector<std::uint32_t> quad = {rings[r].corner(i), rings[r].corner(j)};
            if (rings[r].is_point) quad.pop_back();
            quad.push_back(rings[r + 1].corner(j));
            if (!rings[r + 1].is_point) quad.push_back(rings[r + 1].corner(i));
            mesh.add_face(quad);
        }
    return mesh;
}

/// A body's y axis in the slice: how far it goes along the slice and along the height.
struct TiltedAxis {
    double slice, height;  ///< slice^2 + height^2 = 1, slice >= 0
    Vec3 direction;        ///< in the slice, unit

    explicit TiltedAxis(const Mat4& turn) {
        const Vec3 along = turn.col(1).head<3>();
        slice = along.norm(), height = turn(3, 1);
        direction = slice > 0 ? Vec3(along / slice) : Vec3::UnitX();
    }
};

/// sqrt(a^2 - b^2), 0 where b is larger.
double other_side(double a, double b) { return std::sqrt(std::max(0.0, (a - b) * (a + b))); }

}  // namespace

Mesh section_mesh(const Hypersphere& shape, const PlacedShape& at, double tolerance) {
    const double radius = other_side(shape.radius, at.centre[3]);
    return radius > 0 ? ball_mesh(at.centre.head<3>(), radius, tolerance) : Mesh();
}

/// The balls about the core's points, at t along it, meet the slice in balls about x = slice t.
Mesh section_mesh(const Hypercapsule& shape, const PlacedShape& at, double tolerance) {
    const TiltedAxis axis(at.turn);
    const double half = 0.5 * shape.height, h = at.centre[3], r = shape.radius;
    Revolved solid{at.centre.head<3>(), axis.direction, kMiss, -kMiss, {}};
    const auto reach = [&](double t) {
        const double height = h + t * axis.height;
        if (!(std::abs(height) < r)) return;
        solid.begin = std::min(solid.begin, axis.slice * t - other_side(r, height));
        solid.end = std::max(solid.end, axis.slice * t + other_side(r, height));
    };
    // Farthest is the ball of an end of the core, or one in between where that has a slope of 0.
    for (const double t : {-half, half}) reach(t);
    if (axis.height != 0)
        for (const double side : {-1.0, 1.0}) {
            const double t = (side * axis.slice * r - h) / axis.height;
            if (std::abs(t) < half) reach(t);
        }
    if (!(solid.begin < solid.end)) return {};
    solid.radius = [=](double x) {
        const double along = axis.slice * x - axis.height * h, t = std::clamp(along, -half, half);
        if (t == along) return other_side(r, axis.height * x + axis.slice * h);
        return other_side(other_side(r, h + t * axis.height), x - t * axis.slice);
    };
    return revolved_mesh(solid, tolerance);
}

/// A ball's worth of lines along y, cut off by two planes.
Mesh section_mesh(const Spherinder& shape, const PlacedShape& at, double tolerance) {
    const TiltedAxis axis(at.turn);
    const double half = 0.5 * shape.height, h = at.centre[3], r = shape.radius;
    Revolved solid{at.centre.head<3>(), axis.direction, -kMiss, kMiss, {}};
    const auto keep = [&](double low, double high) {
        solid.begin = std::max(solid.begin, std::min(low, high));
        solid.end = std::min(solid.end, std::max(low, high));
    };
    // y = slice x - height h, and the ball's part of a point is across from the axis and along
    // q = height x + slice h.
    const auto strip = [&](double slope, double offset, double bound) {
        if (slope != 0)
            keep((-bound - offset) / slope, (bound - offset) / slope);
        else if (std::abs(offset) > bound)
            keep(kMiss, kMiss);
    };
    strip(axis.slice, -axis.height * h, half);
    strip(axis.height, axis.slice * h, r);
    if (!(solid.begin < solid.end)) return {};
    solid.radius = [=](double x) { return other_side(r, axis.height * x + axis.slice * h); };
    return revolved_mesh(solid, tolerance);
}

}  // namespace tesserae::scenes
