// SPDX-License-Identifier: Apache-2.0
#include "render/light/shadow.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tesserae::render {
namespace {

/// Of the sine of the angle between a body's normal and the one that is looked for.
constexpr double kNear = 0.02;
/// Usual 2; more are for rays that pass several sides of a body.
constexpr int kMostSteps = 8;

/// Out of a shape where a ray from outside passes it at the least angle, the rim's: there the
/// distance f(t) touches sine * t from above. f being convex, a bracket closes in on it; the steps
/// are Newton's for a double root. Where f has a kink there, as inside of what has faces, it is the
/// mean of the normals on both sides that is at the rim's angle.
template <class S>
Vec4 rim_normal(const S& shape, const Vec4& origin, const Vec4& direction, double limit,
                double sine, FrameStats& stats) {
    double low = 0, high = limit, t = -origin.dot(direction);
    if (!(t > low && t < high)) t = high < kMiss ? high : origin.norm();
    struct Side {
        Vec4 out = Vec4::Zero();
        double slope = 0;
    } before, after;
    for (int i = 0; i < kMostSteps; ++i) {
        ++stats.distance_evaluations;
        const Vec4 point = origin + t * direction;
        const Vec4 out = normal(shape, point);
        const double slope = out.dot(direction) - sine;
        if (std::abs(slope) < kNear) return out;
        (slope < 0 ? before : after) = {out, slope};
        (slope < 0 ? low : high) = t;
        const double step = (signed_distance(shape, point) - sine * t) / slope;
        const auto is_within = [&](double x) { return x > low && x < high; };
        const double middle = high < kMiss ? 0.5 * (low + high) : 2 * low;
        t = is_within(t - 2 * step) ? t - 2 * step : is_within(t - step) ? t - step : middle;
    }
    if (before.slope == 0) return after.out;
    if (after.slope == 0) return before.out;
    return after.slope * before.out - before.slope * after.out;
}

}  // namespace

double rim_sine(const PlacedBodies& placed, std::uint32_t index, const Ray& ray, double low,
                double high, FrameStats& stats) {
    const PlacedBody& body = placed.bodies[index];
    return std::visit(
        [&](const auto& shape) {
            const Rim least = rim(shape, placed.point_to_body(body, ray.origin, ray.time),
                                  placed.direction_to_body(body, ray.direction, ray.time),
                                  {low, high, ray.limit});
            stats.distance_evaluations += static_cast<std::uint64_t>(least.steps);
            return least.sine;
        },
        *body.shape);
}

bool Shadows::is_behind(const Ray& ray, std::uint32_t body) const {
    if (ray.limit == kMiss) return false;
    const PlacedBody& b = placed_.bodies[body];
    return (b.centre - ray.origin).norm() - b.radius > ray.limit;
}

bool Shadows::is_hidden(const Ray& ray, FrameStats& stats) const {
    bool hidden = false;
    const auto clears = [&](std::uint32_t body) {
        hidden = body != ray.on && !is_behind(ray, body) &&
                 rim_sine(placed_, body, ray, 0, 0, stats) < 0;
        return !hidden;
    };
    for (std::uint32_t body : tree_.unbounded())
        if (!clears(body)) return true;
    tree_.for_each_on_ray(ray, clears);
    return hidden;
}

double Shadows::visibility(const LightDisc& light, const Vec4& point, std::uint32_t on,
                           FrameStats& stats, double time) const {
    ++stats.shadow_rays;
    const Ray ray = {point, light.toward, on, std::min(light.limit, limit_), time};
    if (light.angle == 0) return is_hidden(ray, stats) ? 0 : 1;

    thread_local std::vector<DiscCover> covers;  // keeps its memory
    covers.clear();
    bool hidden = false;
    const double most = light.cone.sine;
    const auto take = [&](std::uint32_t body) {
        if (body == on || is_behind(ray, body)) return true;
        const double sine = rim_sine(placed_, body, ray, -most, most, stats);
        hidden = sine <= -most;
        if (!hidden && sine < most) covers.push_back({body, std::asin(sine) / light.angle});
        return !hidden;
    };
    for (std::uint32_t body : tree_.unbounded())
        if (!take(body)) return 0;
    tree_.for_each_in_cone(ray, light.cone, take);
    if (hidden) return 0;
    if (covers.empty()) return 1;
    if (covers.size() == 1) return visible_part(covers[0].rim);
    const TangentFrame frame(light.toward);
    for (DiscCover& cover : covers) complete(cover, light, ray, frame, stats);
    return clear_part(covers);
}

/// Finds where on the disc a cover lies.
void Shadows::complete(DiscCover& cover, const LightDisc& light, const Ray& ray,
                       const TangentFrame& frame, FrameStats& stats) const {
    const PlacedBody& body = placed_.bodies[cover.body];
    const Vec4 origin = placed_.point_to_body(body, ray.origin, ray.time);
    const Vec4 direction = placed_.direction_to_body(body, ray.direction, ray.time);
    const double sine = std::sin(cover.rim * light.angle);
    std::visit(
        [&](const auto& shape) {
            const Vec4 out = rim_normal(shape, origin, direction, ray.limit, sine, stats);
            cover.toward =
                -frame.to_local(placed_.direction_to_world(body, out, ray.time)).head<3>();
            cover.radius =
                std::asin(std::min(1.0, bounding_radius(shape) / origin.norm())) / light.angle;
        },
        *body.shape);
    const double length = cover.toward.norm();
    cover.toward = length > 0 ? Eigen::Vector3d(cover.toward / length) : Eigen::Vector3d::UnitX();
}

}  // namespace tesserae::render
