// SPDX-License-Identifier: Apache-2.0
#include "core/shape/ball_product.hpp"

#include <algorithm>
#include <cmath>

#include "core/shape/convex_rim.hpp"

namespace tesserae {
namespace {

Vec4 part_of(const BallFactor& factor, const Vec4& v) { return factor.axes.cwiseProduct(v); }

/// How far a point is out of a factor's ball.
double distance_to(const BallFactor& factor, const Vec4& point) {
    return stable_norm(part_of(factor, point)) - factor.radius;
}

Vec4 direction_in(const BallFactor& factor, const Vec4& v) {
    const Vec4 part = part_of(factor, v);
    if (!part.isZero(0)) return stable_normalized(part);
    int first;
    factor.axes.maxCoeff(&first);
    return Vec4::Unit(first);
}

/// Which part of a ray is in the shape; enter > leave where it misses. Seen along the other axes a
/// factor is a ball, and the ray's shadow goes slower by the sine of its angle to them.
RayInterval interval_in(const BallProduct& shape, const Vec4& origin, const Vec4& direction) {
    constexpr RayInterval kMissed = {kMiss, 0};
    RayInterval inside = {0, kMiss};
    for (const BallFactor& factor : shape) {
        const Vec4 from = part_of(factor, origin), shadow = part_of(factor, direction);
        const double sine = stable_norm(shadow);
        if (!(sine > 0)) {
            if (stable_norm(from) > factor.radius) return kMissed;
            continue;
        }
        const Hypersphere ball{factor.radius};
        const double enter = ray_hit(ball, from, shadow / sine);
        if (enter == kMiss) return kMissed;
        inside.enter = std::max(inside.enter, enter / sine);
        inside.leave = std::min(inside.leave, ray_exit(ball, from, shadow / sine) / sine);
    }
    return inside;
}

}  // namespace

Vec4 support(const BallFactor& factor, const Vec4& direction) {
    return factor.radius * direction_in(factor, direction);
}

double volume(const BallProduct& shape) {
    constexpr double kUnitBall[] = {1, 2, M_PI, 4.0 / 3.0 * M_PI};
    double content = 1;
    for (const BallFactor& factor : shape) content *= kUnitBall[factor.dimensions];
    // Radii one by one: no vanished power meets an overflown one.
    for (int axis = 0; axis < 4; ++axis)
        for (const BallFactor& factor : shape)
            if (factor.axes[axis] > 0) content *= factor.radius;
    return content;
}

/// A ball of d dimensions has M r^2 / (d + 2) along each of its axes.
Vec4 second_moments(const BallProduct& shape, double mass) {
    Vec4 moments = Vec4::Zero();
    for (const BallFactor& factor : shape) {
        const double own = mass * factor.radius * factor.radius / (factor.dimensions + 2);
        for (int axis = 0; axis < 4; ++axis)
            if (factor.axes[axis] > 0) moments[axis] = own;
    }
    return moments;
}

double bounding_radius(const BallProduct& shape) {
    Vec4 radii = Vec4::Zero();
    for (std::size_t i = 0; i < shape.factors; ++i)
        radii[static_cast<int>(i)] = shape.factor[i].radius;
    return stable_norm(radii);
}

Vec4 half_extents(const BallProduct& shape, const Mat4& rotation) {
    Vec4 half;
    for (int axis = 0; axis < 4; ++axis)
        half[axis] = half_extent_along(shape, rotation.row(axis).transpose());
    return half;
}

double half_extent_along(const BallProduct& shape, const Vec4& direction) {
    double sum = 0;
    for (const BallFactor& factor : shape)
        sum += factor.radius * stable_norm(part_of(factor, direction));
    return sum;
}

Vec4 support(const BallProduct& shape, const Vec4& direction) {
    Vec4 point = Vec4::Zero();
    for (const BallFactor& factor : shape) point += support(factor, direction);
    return point;
}

double signed_distance(const BallProduct& shape, const Vec4& point) {
    double deepest = -kMiss;
    Vec4 beyond = Vec4::Zero();
    for (std::size_t i = 0; i < shape.factors; ++i) {
        const double own = distance_to(shape.factor[i], point);
        deepest = std::max(deepest, own);
        beyond[static_cast<int>(i)] = std::max(own, 0.0);
    }
    return deepest <= 0 ? deepest : stable_norm(beyond);
}

/// Inside the nearest factor's; of several equally near ones the first's. On a factor's middle: its
/// first axis.
Vec4 normal(const BallProduct& shape, const Vec4& point) {
    const BallFactor* nearest = nullptr;
    double deepest = -kMiss;
    Vec4 beyond = Vec4::Zero();
    for (const BallFactor& factor : shape) {
        const double own = distance_to(factor, point);
        if (!nearest || own > deepest) deepest = own, nearest = &factor;
        if (own > 0) beyond += own * direction_in(factor, point);
    }
    return beyond.isZero(0) ? direction_in(*nearest, point) : stable_normalized(beyond);
}

double ray_hit(const BallProduct& shape, const Vec4& origin, const Vec4& direction) {
    const RayInterval inside = interval_in(shape, origin, direction);
    return inside.enter <= inside.leave ? inside.enter : kMiss;
}

/// From the surface, which a start may be off by rounding, the way in begins at that factor's exit.
double ray_exit(const BallProduct& shape, const Vec4& origin, const Vec4& direction) {
    double exit = kMiss;
    for (const BallFactor& factor : shape) {
        const Vec4 from = part_of(factor, origin), shadow = part_of(factor, direction);
        const double sine = stable_norm(shadow);
        if (sine > 0)
            exit = std::min(exit, ray_exit(Hypersphere{factor.radius}, from, shadow / sine) / sine);
    }
    return exit;
}

Rim rim(const BallProduct& shape, const Vec4& origin, const Vec4& direction,
        const RimRange& range) {
    if (const auto known = rim_by_interval(interval_in(shape, origin, direction),
                                           bounding_radius(shape) + stable_norm(origin), range))
        return *known;
    return convex_rim(shape, origin, direction, range);
}

}  // namespace tesserae
