// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/contact/find_contacts.hpp"
#include "core/error.hpp"
#include "core/ranges.hpp"
#include "core/world/check.hpp"
#include "core/world/inside.hpp"

// What lies along a ray, at a place, and nearest to a point.
namespace tesserae {
namespace {

/// A body's place, with the way into its own axes.
struct Placed {
    Placed(const Bodies& bodies, BodyId place)
        : shape(bodies.type_of(place).shape),
          centre(bodies.position[place]),
          turn(to_matrix(bodies.rotor[place])) {}

    Vec4 to_body(const Vec4& direction) const { return turn.transpose() * direction; }
    Vec4 point_in_body(const Vec4& point) const { return to_body(point - centre); }

    const Shape& shape;
    const Vec4& centre;
    Mat4 turn;
};

/// Calls visit(place) for all bodies that no box holds.
template <class Visit>
void for_each_unbounded(const BallTree& tree, const Visit& visit) {
    for (const BodyId place : tree.unbounded()) visit(place);
}

void require_reach(double reach) {
    if (!(reach >= 0)) throw InputError(fmt::format("reach = {}: expected at least 0", reach));
}

}  // namespace

std::optional<RayHit> World::ray(const Vec4& origin, const Vec4& direction, double reach) const {
    check("origin", origin);
    check("direction", direction);
    require_reach(reach);
    if (direction.cwiseAbs().maxCoeff() < kSmallest)
        throw InputError("direction: expected a direction, not zero");
    const Vec4 unit = stable_normalized(direction);
    const Vec4 inverse = unit.cwiseInverse();
    const BallTree& tree = inside_->tree();
    const Bodies& bodies = inside_->simulation().bodies;

    double nearest = reach;
    BodyId first = kWorld;
    const auto visit = [&](BodyId place) {
        const Placed body(bodies, place);
        const Vec4 from = body.point_in_body(origin), along = body.to_body(unit);
        const double distance =
            std::visit([&](const auto& s) { return ray_hit(s, from, along); }, body.shape);
        // Of bodies at the same distance the lowest counts.
        if (distance < nearest || (distance == nearest && distance != kMiss && place < first))
            nearest = distance, first = place;
    };
    for_each_unbounded(tree, visit);
    tree.walk([&](const BallTree::Box& box) { return box.entry(origin, inverse); },
              [&] { return std::min(nearest, std::numeric_limits<double>::max()); }, visit);
    if (first == kWorld) return {};
    const Placed body(bodies, first);
    const Vec4 point = origin + nearest * unit;
    return RayHit{inside_->bodies()[first], nearest, point,
                  body.turn * surface_normal(body.shape, body.point_in_body(point))};
}

std::vector<BodyId> World::overlapping(const Shape& shape, const Vec4& position,
                                       const Rotor& rotor) const {
    Shape whole = shape;
    make_complete(whole);
    check(BodyState{position, rotor, Vec4::Zero(), {}});
    if (!is_bounded(whole))
        throw InputError(fmt::format("shape: is a {}; expected a bounded one", name_of(whole)));
    const BallTree& tree = inside_->tree();
    const Bodies& bodies = inside_->simulation().bodies;
    std::vector<BodyId> found;
    std::vector<Contact> contacts;
    const auto visit = [&](BodyId place) {
        contacts.clear();
        find_contacts(0, whole, {position, rotor}, 1, bodies.type_of(place).shape,
                      {bodies.position[place], bodies.rotor[place]}, 0, contacts);
        if (!contacts.empty()) found.push_back(inside_->bodies()[place]);
    };
    for_each_unbounded(tree, visit);
    const double radius = bounding_radius(whole);
    tree.walk([&](const BallTree::Box& box) { return box.distance(position); },
              [&] { return radius; }, visit);
    std::sort(found.begin(), found.end());
    return found;
}

std::optional<Nearest> World::nearest(const Vec4& point, double reach) const {
    check("point", point);
    require_reach(reach);
    const BallTree& tree = inside_->tree();
    const Bodies& bodies = inside_->simulation().bodies;
    double least = reach;
    BodyId nearest = kWorld;
    const auto visit = [&](BodyId place) {
        const Placed body(bodies, place);
        const Vec4 at = body.point_in_body(point);
        const double distance =
            std::visit([&](const auto& s) { return signed_distance(s, at); }, body.shape);
        if (distance < least || (distance == least && place < nearest))
            least = distance, nearest = place;
    };
    for_each_unbounded(tree, visit);
    // In a box the distance may be anything below 0.
    tree.walk([&](const BallTree::Box& box) { return box.distance(point); },
              [&] { return std::clamp(least, 0.0, std::numeric_limits<double>::max()); }, visit);
    if (nearest == kWorld) return {};
    const Placed body(bodies, nearest);
    const Vec4 at = body.point_in_body(point);
    const Vec4 outward =
        body.turn * std::visit([&](const auto& s) { return normal(s, at); }, body.shape);
    return Nearest{inside_->bodies()[nearest], least, point - least * outward, outward};
}

}  // namespace tesserae
