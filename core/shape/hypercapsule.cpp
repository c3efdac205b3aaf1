// SPDX-License-Identifier: Apache-2.0
#include "core/shape/hypercapsule.hpp"

#include <algorithm>
#include <cmath>

#include "core/shape/hypersphere.hpp"

namespace tesserae {
namespace {

/// From the core's closest point to `point`.
Vec4 offset_from_core(const Hypercapsule& shape, Vec4 point) {
    const double half = 0.5 * shape.height;
    point[1] -= std::clamp(point[1], -half, half);
    return point;
}

/// v without its part along the axis.
Vec4 across(Vec4 v) {
    v[1] = 0;
    return v;
}

}  // namespace

/// A spherinder (ball of three dimensions times the core) and two half hyperspheres:
/// (4/3) pi R^3 H + pi^2 R^4 / 2.
double volume(const Hypercapsule& shape) {
    // The height comes first: 0 times an overflown cube would be no number.
    const double r = shape.radius;
    return shape.height * (4.0 / 3.0 * M_PI) * r * r * r + volume(Hypersphere{r});
}

/// core/FORMULAS.md 2: the two parts' own moments, and the caps' shift along the axis. The centre
/// of a half hypersphere lies 16 R / (15 pi) from its flat side.
Vec4 second_moments(const Hypercapsule& shape, double mass) {
    const double r = shape.radius, h = shape.height;
    const double parts = 8 * h + 3 * M_PI * r;
    const double spherinder = mass * (8 * h / parts);
    const double caps = mass * (3 * M_PI * r / parts);
    // Each product starts with a mass: a vanishing part times an overflown square stays a number.
    const double across_axis = spherinder * r * r / 5 + caps * r * r / 6;
    const double along_axis = spherinder * h * h / 12 + caps * r * r / 6 + caps * h * h / 4 +
                              16 / (15 * M_PI) * caps * r * h;
    return {across_axis, along_axis, across_axis, across_axis};
}

double bounding_radius(const Hypercapsule& shape) { return 0.5 * shape.height + shape.radius; }

Vec4 half_extents(const Hypercapsule& shape, const Mat4& rotation) {
    return (0.5 * shape.height * rotation.col(1).cwiseAbs()).array() + shape.radius;
}

double half_extent_along(const Hypercapsule& shape, const Vec4& direction) {
    return 0.5 * shape.height * std::abs(direction[1]) + shape.radius * stable_norm(direction);
}

/// A direction across the axis, where a whole segment is farthest: its end towards +y.
Vec4 support(const Hypercapsule& shape, const Vec4& direction) {
    Vec4 point = support(Hypersphere{shape.radius}, direction);
    point[1] += direction[1] < 0 ? -0.5 * shape.height : 0.5 * shape.height;
    return point;
}

double signed_distance(const Hypercapsule& shape, const Vec4& point) {
    return stable_norm(offset_from_core(shape, point)) - shape.radius;
}

/// On the core: +x, orthogonal to it; for height 0 the hypersphere's choice.
Vec4 normal(const Hypercapsule& shape, const Vec4& point) {
    const Vec4 offset = offset_from_core(shape, point);
    if (offset.isZero(0) && shape.height > 0) return Vec4::UnitX();
    return normal(Hypersphere{shape.radius}, offset);
}

double ray_hit(const Hypercapsule& shape, const Vec4& origin, const Vec4& direction) {
    if (signed_distance(shape, origin) <= 0) return 0;
    const Hypersphere ball{shape.radius};
    const double half = 0.5 * shape.height;

    // Seen along the axis the capsule is a ball: the ray enters the unending wall where its shadow
    // enters that ball. If this is beside the core, nothing of the capsule comes earlier.
    const double sine = stable_norm(across(direction));
    if (sine > 0) {
        const double shadow = ray_hit(ball, across(origin), across(direction) / sine);
        if (shadow == kMiss) return kMiss;
        const double wall = shadow / sine;
        if (std::abs(origin[1] + wall * direction[1]) <= half) return wall;
    }

    // Else it can only enter through a cap.
    const Vec4 end = half * Vec4::UnitY();
    return std::min(ray_hit(ball, origin - end, direction), ray_hit(ball, origin + end, direction));
}

/// The ray leaves through the wall if that is beside the core, else through the cap on whose side
/// it leaves the unending wall: leaving by the other cap it would have to enter the capsule again.
double ray_exit(const Hypercapsule& shape, const Vec4& origin, const Vec4& direction) {
    const Hypersphere ball{shape.radius};
    const double half = 0.5 * shape.height;
    double height = direction[1] * kMiss;
    const double sine = stable_norm(across(direction));
    if (sine > 0) {
        const double wall = ray_exit(ball, across(origin), across(direction) / sine) / sine;
        height = origin[1] + wall * direction[1];
        if (std::abs(height) <= half) return wall;
    }
    const Vec4 end = (height > 0 ? half : -half) * Vec4::UnitY();
    return ray_exit(ball, origin - end, direction);
}

/// Seen along the axis the capsule is a ball, of which the ray's shadow meets the least ratio
/// somewhere: f(t)/t of the unending wall, by the shadow's length shorter. If that is beside the
/// core it is the capsule's, else the end on whose side it lies has the least: as a function of 1/t
/// and the core's point over t, the ratio is convex.
Rim rim(const Hypercapsule& shape, const Vec4& origin, const Vec4& direction,
        const RimRange& range) {
    const double r = shape.radius, half = 0.5 * shape.height;
    const double unit = std::max({origin.cwiseAbs().maxCoeff(), r, half});
    if (!(unit > 1e-100 && unit < 1e100))
        return rim(Hypercapsule{r / unit, shape.height / unit}, origin / unit, direction,
                   {range.low, range.high, range.limit / unit});
    const double distance = signed_distance(shape, origin);
    if (distance <= 0)
        return rim_from_inside(distance, normal(shape, origin).dot(direction), r + half);

    BallRim least = {1, kMiss};
    double height = origin[1];
    const Vec4 beside = across(origin);
    const double square = beside.squaredNorm();
    if (square > r * r) {
        const double sine = across(direction).norm();
        if (sine > 0) {
            least = ball_rim(r, beside, square, across(direction) / sine);
            least = {least.sine * sine, least.distance / sine};
        }
        height = direction[1] == 0 ? origin[1] : origin[1] + least.distance * direction[1];
    }
    if (!(square > r * r && std::abs(height) <= half)) {
        const Vec4 from_end = origin - (height > 0 ? half : -half) * Vec4::UnitY();
        least = ball_rim(r, from_end, from_end.squaredNorm(), direction);
    }
    if (range.limit < least.distance)
        return {signed_distance(shape, origin + range.limit * direction) / range.limit};
    return {least.sine};
}

}  // namespace tesserae
