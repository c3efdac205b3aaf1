// SPDX-License-Identifier: Apache-2.0
#include "core/shape/hypersphere.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae {

/// pi^2 R^4 / 2.
double volume(const Hypersphere& shape) {
    const double r = shape.radius;
    return 0.5 * M_PI * M_PI * r * r * r * r;
}

/// M R^2 / 6 along every axis (so every plane's inertia is M R^2 / 3).
Vec4 second_moments(const Hypersphere& shape, double mass) {
    return Vec4::Constant(mass * shape.radius * shape.radius / 6);
}

double bounding_radius(const Hypersphere& shape) { return shape.radius; }

Vec4 half_extents(const Hypersphere& shape, const Mat4&) { return Vec4::Constant(shape.radius); }

double half_extent_along(const Hypersphere& shape, const Vec4& direction) {
    return shape.radius * stable_norm(direction);
}

/// For a zero direction, where all points are equal: the one along +y.
Vec4 support(const Hypersphere& shape, const Vec4& direction) {
    return shape.radius * normal(shape, direction);
}

double signed_distance(const Hypersphere& shape, const Vec4& point) {
    return stable_norm(point) - shape.radius;
}

/// At the centre: +y.
Vec4 normal(const Hypersphere&, const Vec4& point) {
    return point.isZero(0) ? Vec4(Vec4::UnitY()) : stable_normalized(point);
}

/// Source: the quadratic's roots by way of the point of the ray nearest to the centre, which loses
/// nothing far away (Haines et al., Ray Tracing Gems, 2019, chapter 7); the nearer root as the
/// quotient c / (b + h), which loses nothing close to the surface.
double ray_hit(const Hypersphere& shape, const Vec4& origin, const Vec4& direction) {
    const double r = shape.radius;
    const double distance = stable_norm(origin);
    if (distance <= r) return 0;

    // Go to the nearest point of the ray's line. Comparisons are written to fail on a NaN, which
    // only coordinates at the end of double's range can bring about.
    const double nearest = -origin.dot(direction);
    if (!(nearest > 0)) return kMiss;
    const double sine = stable_norm(origin + nearest * direction) / r;
    if (!(sine <= 1)) return kMiss;

    // Come back by half the chord.
    const double half_chord = r * std::sqrt((1 - sine) * (1 + sine));
    return (distance - r) * ((distance + r) / (nearest + half_chord));
}

/// The farther root: forward of the middle of the chord as a sum, behind it as a quotient.
double ray_exit(const Hypersphere& shape, const Vec4& origin, const Vec4& direction) {
    const double r = shape.radius;
    const double nearest = -origin.dot(direction);
    const double sine = std::min(1.0, stable_norm(origin + nearest * direction) / r);
    const double half_chord = r * std::sqrt((1 - sine) * (1 + sine));
    if (nearest >= 0) return nearest + half_chord;
    const double distance = stable_norm(origin);
    return std::max(0.0, (r - distance) * ((r + distance) / (half_chord - nearest)));
}

/// With D the centre's distance, theta the angle to it and alpha that to the rim: sin(theta -
/// alpha), at t = D cos(alpha)/cos(theta - alpha).
BallRim ball_rim(double radius, const Vec4& origin, double square, const Vec4& direction) {
    // Cosines and sines of theta and alpha, times D.
    const double cos_theta = -origin.dot(direction);
    const double sin_theta = (origin + cos_theta * direction).norm();
    const double cos_alpha = std::sqrt(square - radius * radius);
    const double cos_between = cos_theta * cos_alpha + sin_theta * radius;
    if (!(cos_between > 0)) return {1, kMiss};
    return {(sin_theta * cos_alpha - cos_theta * radius) / square,
            square / cos_between * cos_alpha};
}

Rim rim(const Hypersphere& shape, const Vec4& origin, const Vec4& direction,
        const RimRange& range) {
    const double square = origin.squaredNorm(), r = shape.radius;
    if (!is_plain_square(square + r * r)) {
        const double unit = std::max(origin.cwiseAbs().maxCoeff(), r);
        return rim(Hypersphere{r / unit}, origin / unit, direction,
                   {range.low, range.high, range.limit / unit});
    }
    if (square <= r * r) {
        const double distance = std::sqrt(square);
        return rim_from_inside(distance - r, direction.dot(origin) / distance, r);
    }
    const BallRim least = ball_rim(r, origin, square, direction);
    if (range.limit < least.distance)
        return {((origin + range.limit * direction).norm() - r) / range.limit};
    return {least.sine};
}

}  // namespace tesserae
