// SPDX-License-Identifier: Apache-2.0
#include "render/scene/intersect.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae::render {
namespace {

/// A point counts as on the surface when its distance is below this times the size of the numbers
/// that went into it: some hundred rounding units. At grazing incidence, where the distance along
/// the ray grows with the square, a hit is then early by at most sqrt(2 radius 1e-13 scale).
constexpr double kOnSurface = 1e-13;

/// The signed distance, or a quicker function, and its slope along a ray.
struct LevelAlong {
    double value, slope;
};
/// @param near   the slope is not asked for at values up to this
template <class S>
LevelAlong level_along(const S& shape, const Vec4& point, const Vec4& direction, double near) {
    if constexpr (HasQuickLevel<S>) {
        const Level level = quick_level(shape, point);
        return {level.value, level.gradient.dot(direction)};
    } else {
        const double distance = signed_distance(shape, point);
        return {distance, distance <= near ? 0 : normal(shape, point).dot(direction)};
    }
}

/// Sphere tracing with the step lengthened by the slope. The signed distance f of a convex body is
/// a convex function along a ray, so the tangent at t crosses zero no later than f does: the step
/// f/(-f') never passes the surface, is never shorter than the plain step f (as -f' <= 1), and
/// converges quadratically. For the same reason f > 0 with f' >= 0 proves a miss.
/// When the steps are used up the ray has neither met nor missed the body: it counts as a hit where
/// it stands (never a leak) and in stats.unresolved.
/// @param start, end   the part of the ray that can meet the body
template <class S>
double trace(const S& shape, const Vec4& origin, const Vec4& direction, double start, double end,
             int max_steps, FrameStats& stats) {
    const double scale = origin.norm();
    double t = start;
    for (int step = 0; step < max_steps; ++step) {
        const Vec4 point = origin + t * direction;
        const auto [distance, slope] =
            level_along(shape, point, direction, kOnSurface * (scale + t));
        ++stats.distance_evaluations;
        if (distance <= kOnSurface * (scale + t)) return t;
        if (slope >= 0) return kMiss;
        t += std::max(distance, distance / -slope);
        if (t > end) return kMiss;
    }
    // A step along a surface may overflow: from there all distances are infinite or no numbers.
    if (!(t < kMiss)) return kMiss;
    ++stats.unresolved;
    return t;
}

/// Where the ray is inside the sphere about the origin; empty (start > end) if nowhere. The
/// distance to the ray's line is taken from its vector, which does not cancel.
struct Span {
    double start, end;
};
Span inside_sphere(const Vec4& origin, const Vec4& direction, double radius) {
    const double middle = -origin.dot(direction);
    const double off = (origin + middle * direction).squaredNorm();
    const double square = radius * radius - off;
    if (!(square >= 0)) return {kMiss, -kMiss};
    const double half = std::sqrt(square);
    return {middle - half, middle + half};
}

}  // namespace

template <class S>
double hit_distance(const S& shape, const Vec4& origin, const Vec4& direction, double limit,
                    const Settings& settings, FrameStats& stats) {
    if (settings.intersector == Intersector::kAnalytic) {
        const double t = ray_hit(shape, origin, direction);
        return t <= limit ? t : kMiss;
    }
    double start = 0, end = limit;
    if constexpr (S::kBounded) {
        const Span inside = inside_sphere(origin, direction, bounding_radius(shape));
        start = std::max(start, inside.start);
        end = std::min(end, inside.end + kOnSurface * inside.end);
        if (start > end) return kMiss;
    }
    return trace(shape, origin, direction, start, end, settings.max_steps, stats);
}
template double hit_distance(const Hypersphere&, const Vec4&, const Vec4&, double, const Settings&,
                             FrameStats&);
template double hit_distance(const Hyperbox&, const Vec4&, const Vec4&, double, const Settings&,
                             FrameStats&);

double hit_distance(const PlacedBodies& placed, std::uint32_t index, const Ray& ray,
                    const Settings& settings, FrameStats& stats) {
    const PlacedBody& body = placed.bodies[index];
    const auto in_frame = [&](const Vec4& o, const Vec4& d) {
        return std::visit(
            [&](const auto& shape) {
                return hit_distance(shape, o, d, ray.limit, settings, stats);
            },
            *body.shape);
    };
    if (body.moves()) {
        const Pose pose = placed.pose(body, ray.time);
        return in_frame(pose.turn * (ray.origin - pose.centre), pose.turn * ray.direction);
    }
    // Two calls: a choice of vectors would be copied by halves, and reading them back stalls.
    if (body.turn == PlacedBody::kNotTurned)
        return in_frame(ray.origin - body.centre, ray.direction);
    const Mat4& turn = placed.turns[body.turn];
    return in_frame(turn * (ray.origin - body.centre), turn * ray.direction);
}

}  // namespace tesserae::render
