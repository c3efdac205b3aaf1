#include "render/scene/glass_bodies.hpp"

#include <algorithm>
#include <limits>

namespace tesserae::render {
namespace {

/// A point deeper than this part of the lengths involved is inside: rounding leaves points of a
/// surface on either side of it.
constexpr double kInside = 1e-9;

const Material& material_of(const Picture& picture, BodyId id) {
    return picture.materials[picture.appearance[picture.bodies.type[id]].material];
}

double distance_of(const PlacedBodies& placed, const PlacedBody& body, const Vec4& point) {
    return std::visit(
        [&](const auto& s) { return signed_distance(s, placed.point_to_body(body, point)); },
        *body.shape);
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

double GlassBodies::refractive_index(std::uint32_t medium) const {
    return medium == kNone ? 1 : material_of(picture_, placed_.bodies[medium].id).ior;
}

GlassBodies::Event GlassBodies::next(std::uint32_t medium, Ray ray, FrameStats& stats) const {
    const PlacedBody& glass = placed_.bodies[medium];
    const double exit = std::visit(
        [&](const auto& s) {
            return ray_exit(s, placed_.point_to_body(glass, ray.origin),
                            placed_.direction_to_body(glass, ray.direction));
        },
        *glass.shape);
    Hit hit;
    ray.limit = exit;
    for (const std::uint32_t body : neighbours_[slot_[medium]]) {
        if (body == ray.on || (is_glass(body) && body > medium)) continue;
        if (hit.take(body, hit_distance(placed_, body, ray, picture_.settings, stats)))
            ray.limit = hit.distance;
    }
    // What is met where the ray leaves is outside.
    if (exit <= hit.distance && exit < kMiss) return {{exit, medium}, true};
    return {hit, false};
}

std::uint32_t GlassBodies::medium_beyond(std::uint32_t body, const Vec4& point) const {
    for (const std::uint32_t other : neighbours_[slot_[body]]) {
        const PlacedBody& o = placed_.bodies[other];
        const double scale = point.norm() + (o.radius < kInfinite ? o.radius : 0);
        if (is_glass(other) && distance_of(placed_, o, point) < -kInside * scale) return other;
    }
    return kNone;
}

}  // namespace tesserae::render
