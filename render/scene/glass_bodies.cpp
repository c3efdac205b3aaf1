// SPDX-License-Identifier: Apache-2.0
#include "render/scene/glass_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tesserae::render {
namespace {

/// A point deeper than this part of the lengths involved is inside, one less deep on the surface:
/// rounding leaves points of a surface on either side of it.
constexpr double kInside = 1e-9;

const Material& material_of(const Picture& picture, BodyId id) {
    return picture.materials[picture.appearance[picture.bodies.type[id]].material];
}

double distance_of(const PlacedBodies& placed, const PlacedBody& body, const Vec4& point,
                   double time = 0) {
    return std::visit(
        [&](const auto& s) { return signed_distance(s, placed.point_to_body(body, point, time)); },
        *body.shape);
}

/// Out of the body, unit, world axes.
Vec4 normal_of(const PlacedBodies& placed, const PlacedBody& body, const Vec4& point,
               double time = 0) {
    const Vec4 local = placed.point_to_body(body, point, time);
    return placed.direction_to_world(body, surface_normal(*body.shape, local), time);
}

/// A point of a bounded body that is farthest along a direction.
Vec4 support_of(const PlacedBodies& placed, const PlacedBody& body, const Vec4& direction) {
    const Vec4 along = placed.direction_to_body(body, direction);
    const Vec4 point = std::visit([&](const auto& s) { return support(s, along); }, *body.shape);
    return body.centre + placed.direction_to_world(body, point);
}

/// Whether a body holds all of another, to rounding. The distance from `outer` is convex, so that
/// it is greatest in extreme points of `inner`. From any point the one that is farthest along the
/// distance's gradient has a greater one; such climbs begin at corners of `inner` and where it is
/// nearest to the sides of `outer`, as from there no climb can miss the greatest: of a shape that
/// has neither, all climbs end in the same point.
bool holds(const PlacedBodies& placed, const PlacedBody& outer, const PlacedBody& inner) {
    if (inner.radius == kInfinite) {
        const auto* a = std::get_if<Hyperplane>(outer.shape);
        const auto* b = std::get_if<Hyperplane>(inner.shape);
        return a && b && a->normal == b->normal && b->offset <= a->offset;
    }
    constexpr int kSteps = 32;
    const auto sticks_out = [&](Vec4 direction) {
        for (int i = 0; i < kSteps; ++i) {
            const Vec4 point = support_of(placed, inner, direction);
            if (distance_of(placed, outer, point) > kInside * (inner.radius + point.norm()))
                return true;
            const Vec4 next = normal_of(placed, outer, point);
            if (next == direction) break;
            direction = next;
        }
        return false;
    };
    for (unsigned corner = 0; corner < 16; ++corner) {
        Vec4 direction;
        for (int axis = 0; axis < 4; ++axis) direction[axis] = corner >> axis & 1 ? 0.5 : -0.5;
        if (sticks_out(placed.direction_to_world(inner, direction))) return false;
    }
    for (int axis = 0; axis < 4; ++axis)
        for (const double side : {1.0, -1.0})
            if (sticks_out(placed.direction_to_world(outer, side * Vec4::Unit(axis)))) return false;
    return true;
}

}  // namespace

GlassBodies::GlassBodies(const Picture& picture, const PlacedBodies& placed)
    : picture_(picture), placed_(placed), slot_(placed.bodies.size(), kNone) {
    for (std::uint32_t i = 0; i < placed.bodies.size(); ++i)
        if (material_of(picture, placed.bodies[i].id).kind == MaterialKind::kGlass) {
            slot_[i] = static_cast<std::uint32_t>(neighbours_.size());
            neighbours_.emplace_back();
        }
    if (!neighbours_.empty()) find_neighbours();
}

/// How far a point is from a body, wherever that is: no more than this.
double GlassBodies::distance_from(const PlacedBody& body, const Vec4& point) const {
    return body.moves() ? (point - body.centre).norm() - body.radius
                        : distance_of(placed_, body, point);
}

bool GlassBodies::reach_each_other(std::uint32_t a, std::uint32_t b) const {
    const PlacedBody &p = placed_.bodies[a], &q = placed_.bodies[b];
    if (p.radius == kInfinite)
        return q.radius == kInfinite || distance_of(placed_, p, q.centre) <= q.radius;
    if (q.radius == kInfinite) return distance_of(placed_, q, p.centre) <= p.radius;
    return (p.centre - q.centre).norm() <= p.radius + q.radius;
}

/// Bounded bodies sorted along x: those that reach a glass body begin no more than the greatest
/// diameter before it.
void GlassBodies::find_neighbours() {
    std::vector<std::uint32_t> sorted, unbounded;
    double greatest = 0;
    const auto begin_of = [&](std::uint32_t i) {
        return placed_.bodies[i].centre.x() - placed_.bodies[i].radius;
    };
    for (std::uint32_t i = 0; i < placed_.bodies.size(); ++i) {
        const bool is_bounded = placed_.bodies[i].radius < kInfinite;
        (is_bounded ? sorted : unbounded).push_back(i);
        if (is_bounded) greatest = std::max(greatest, placed_.bodies[i].radius);
    }
    std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
        return begin_of(a) != begin_of(b) ? begin_of(a) < begin_of(b) : a < b;
    });
    for (std::uint32_t glass = 0; glass < slot_.size(); ++glass) {
        if (!is_glass(glass)) continue;
        auto& list = neighbours_[slot_[glass]];
        const auto add = [&](std::uint32_t body) {
            if (body != glass && reach_each_other(glass, body)) list.push_back(body);
        };
        const PlacedBody& g = placed_.bodies[glass];
        const double from = begin_of(glass) - 2 * greatest, to = g.centre.x() + g.radius;
        const auto first = std::partition_point(
            sorted.begin(), sorted.end(), [&](std::uint32_t i) { return begin_of(i) < from; });
        for (auto i = g.radius < kInfinite ? first : sorted.begin();
             i != sorted.end() && begin_of(*i) <= to; ++i)
            add(*i);
        for (std::uint32_t body : unbounded) add(body);
        std::sort(list.begin(), list.end());
    }
}

std::uint32_t GlassBodies::hidden_in(std::uint32_t body) const {
    if (!is_glass(body)) return kNone;
    const auto& others = neighbours_[slot_[body]];
    for (auto other = others.rbegin(); other != others.rend() && *other > body; ++other)
        if (is_glass(*other) && holds(placed_, placed_.bodies[*other], placed_.bodies[body]))
            return *other;
    return kNone;
}

double GlassBodies::refractive_index(std::uint32_t medium) const {
    return medium == kNone ? 1 : material_of(picture_, placed_.bodies[medium].id).ior;
}

std::vector<std::uint32_t> GlassBodies::about(const Vec4& point, double reach) const {
    std::vector<std::uint32_t> bodies;
    for (auto i = static_cast<std::uint32_t>(slot_.size()); i-- > 0;)
        if (is_glass(i) && distance_from(placed_.bodies[i], point) <= reach) bodies.push_back(i);
    return bodies;
}

std::uint32_t GlassBodies::medium_at(const Vec4& point, std::span<const std::uint32_t> bodies,
                                     double time) const {
    const auto ruler = std::find_if(bodies.begin(), bodies.end(), [&](std::uint32_t body) {
        return depth(body, point, time) > kInside;
    });
    return ruler == bodies.end() ? kNone : *ruler;
}

GlassBodies::Event GlassBodies::next(std::uint32_t medium, Ray ray, FrameStats& stats) const {
    const PlacedBody& glass = placed_.bodies[medium];
    const double exit = std::visit(
        [&](const auto& s) {
            return ray_exit(s, placed_.point_to_body(glass, ray.origin, ray.time),
                            placed_.direction_to_body(glass, ray.direction, ray.time));
        },
        *glass.shape);
    Hit hit;
    const double limit = ray.limit;
    ray.limit = std::min(exit, limit);
    for (const std::uint32_t body : neighbours_[slot_[medium]]) {
        if (body == ray.on || (is_glass(body) && body < medium)) continue;
        if (hit.take(body, hit_distance(placed_, body, ray, picture_.settings, stats)))
            ray.limit = hit.distance;
    }
    // What is met where the ray leaves is outside.
    if (exit <= hit.distance && exit <= limit && exit < kMiss) return {{exit, medium}, true};
    return {ruling(hit, ray), false};
}

/// The lengths involved in where a point is in a body [m].
double GlassBodies::scale(std::uint32_t body, const Vec4& point) const {
    const PlacedBody& b = placed_.bodies[body];
    return point.norm() + (b.radius < kInfinite ? b.radius : b.centre.norm());
}

/// How deep a point lies in a body, in parts of the lengths involved.
double GlassBodies::depth(std::uint32_t body, const Vec4& point, double time) const {
    return -distance_of(placed_, placed_.bodies[body], point, time) / scale(body, point);
}

Hit GlassBodies::ruling_of_all(const Hit& hit, const Ray& ray) const {
    if (!hit || !is_glass(hit.body)) return hit;
    const auto& others = neighbours_[slot_[hit.body]];
    const Vec4 point = ray.at(hit.distance);
    for (auto other = others.rbegin(); other != others.rend() && *other > hit.body; ++other)
        if (*other != ray.on && is_glass(*other) &&
            std::abs(depth(*other, point, ray.time)) <= kInside &&
            normal_of(placed_, placed_.bodies[*other], point, ray.time).dot(ray.direction) < 0)
            return {hit.distance, *other};
    return hit;
}

Vec4 GlassBodies::start_outside(std::uint32_t body, Vec4 point, const Vec4& direction,
                                double time) const {
    for (const std::uint32_t other : neighbours_[slot_[body]]) {
        if (!is_glass(other) || std::abs(depth(other, point, time)) > kInside) continue;
        const Vec4 out = normal_of(placed_, placed_.bodies[other], point, time);
        if (out.dot(direction) > 0) point += 2 * kInside * scale(other, point) * out;
    }
    return point;
}

std::uint32_t GlassBodies::medium_beyond(std::uint32_t body, const Vec4& point, double time) const {
    const auto& others = neighbours_[slot_[body]];
    const auto ruler = std::find_if(others.rbegin(), others.rend(), [&](std::uint32_t other) {
        return is_glass(other) && depth(other, point, time) > kInside;
    });
    return ruler == others.rend() ? kNone : *ruler;
}

}  // namespace tesserae::render
