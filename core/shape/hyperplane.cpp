// SPDX-License-Identifier: Apache-2.0
#include "core/shape/hyperplane.hpp"

#include <algorithm>

namespace tesserae {

/// Any finite nonzero normal, however long or short.
void complete(Hyperplane& shape) { shape.normal = stable_normalized(shape.normal); }

double volume(const Hyperplane&) { return kMiss; }

/// Infinite, whatever the mass: no torque turns it.
Vec4 second_moments(const Hyperplane&, double) { return Vec4::Constant(kMiss); }

double bounding_radius(const Hyperplane&) { return kMiss; }

Vec4 half_extents(const Hyperplane&, const Mat4&) { return Vec4::Constant(kMiss); }

double half_extent_along(const Hyperplane&, const Vec4&) { return kMiss; }

/// Only along the normal (to 1e-14 rad) is there a farthest point: the boundary's nearest to the
/// world's origin. Any other direction: all components infinite.
Vec4 support(const Hyperplane& shape, const Vec4& direction) {
    const Vec4 along = direction.isZero(0) ? shape.normal : stable_normalized(direction);
    if ((along - shape.normal).norm() > 1e-14) return Vec4::Constant(kMiss);
    return shape.offset * shape.normal;
}

Face face_along(const Hyperplane& shape, const Vec4&) { return {shape.normal, shape.offset}; }

std::uint64_t faces_near(const Hyperplane& shape, const Vec4& point, double depth) {
    return signed_distance(shape, point) >= -depth ? 1 : 0;
}

double signed_distance(const Hyperplane& shape, const Vec4& point) {
    return shape.normal.dot(point) - shape.offset;
}

Vec4 normal(const Hyperplane& shape, const Vec4&) { return shape.normal; }

double ray_hit(const Hyperplane& shape, const Vec4& origin, const Vec4& direction) {
    const double distance = signed_distance(shape, origin);
    if (distance <= 0) return 0;
    const double approach = -shape.normal.dot(direction);
    return approach > 0 ? distance / approach : kMiss;
}

double ray_exit(const Hyperplane& shape, const Vec4& origin, const Vec4& direction) {
    const double away = shape.normal.dot(direction);
    if (!(away > 0)) return kMiss;
    return std::max(0.0, -signed_distance(shape, origin) / away);
}

/// f is linear, and f/t falls toward its slope.
Rim rim(const Hyperplane& shape, const Vec4& origin, const Vec4& direction, const RimRange& range) {
    const double distance = signed_distance(shape, origin);
    const double slope = shape.normal.dot(direction);
    if (distance <= 0) return rim_from_inside(distance, slope, stable_norm(origin));
    return {slope + distance / range.limit};
}

}  // namespace tesserae
