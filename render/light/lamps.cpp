// SPDX-License-Identifier: Apache-2.0
#include "render/light/lamps.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tesserae::render {
namespace {

/// Black if it is no lamp.
Color glow_of(const Picture& picture, BodyId id) {
    const Appearance& seen = picture.appearance[picture.bodies.type[id]];
    if (!seen.visible || !is_bounded(picture.bodies.type_of(id).shape)) return Color::Zero();
    return picture.materials[seen.material].emission;
}

/// How much a lamp shines in all directions, about: its radiance times its mean section.
double power_of(const Color& radiance, const Shape& shape) {
    const double content = std::visit([](const auto& s) { return volume(s); }, shape);
    return radiance.sum() * std::pow(content, 0.75);
}

}  // namespace

std::size_t count_glowing(const Picture& picture) {
    std::size_t count = 0;
    for (BodyId id = 0; id < picture.bodies.size(); ++id) count += (glow_of(picture, id) > 0).any();
    return count;
}

Lamps::Lamps(const LightSet& lights, const Picture& picture, const PlacedBodies& placed) {
    for (std::uint32_t i = 0; i < lights.spheres.size(); ++i) {
        const SphereLight& s = lights.spheres[i];
        lamps_.push_back({s.position, s.radius, s.radiance,
                          power_of(s.radiance, Hypersphere{s.radius}), i, kNoBody});
    }
    for (std::uint32_t i = 0; i < placed.bodies.size(); ++i) {
        const PlacedBody& body = placed.bodies[i];
        const Color emission = glow_of(picture, body.id);
        if (!(emission > 0).any()) continue;
        if (of_body_.empty()) of_body_.assign(placed.bodies.size(), kNone);
        of_body_[i] = static_cast<std::uint32_t>(lamps_.size());
        lamps_.push_back(
            {body.centre, body.radius, emission, power_of(emission, *body.shape), kNone, i});
    }
    if (lamps_.size() <= kEach) return;
    std::vector<std::uint32_t> order(lamps_.size());
    std::iota(order.begin(), order.end(), 0u);
    leaf_.resize(lamps_.size());
    nodes_.reserve(2 * lamps_.size());
    lamp_.reserve(2 * lamps_.size());
    add_node(kNone, order);
    split(0, order);
}

std::uint32_t Lamps::asked() const {
    return nodes_.empty() ? static_cast<std::uint32_t>(lamps_.size()) : 1;
}

std::uint32_t Lamps::add_node(std::uint32_t parent, std::span<std::uint32_t> lamps) {
    Vec4 low = lamps_[lamps[0]].centre, high = low;
    Node node{};
    for (const std::uint32_t i : lamps) {
        low = low.cwiseMin(lamps_[i].centre), high = high.cwiseMax(lamps_[i].centre);
        node.power += lamps_[i].power;
    }
    node.centre = 0.5 * (low + high);
    for (const std::uint32_t i : lamps)
        node.radius =
            std::max(node.radius, (lamps_[i].centre - node.centre).norm() + lamps_[i].radius);
    node.parent = parent, node.child = kNone;
    nodes_.push_back(node);
    lamp_.push_back(lamps[0]);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

void Lamps::split(std::uint32_t node, std::span<std::uint32_t> lamps) {
    if (lamps.size() == 1) {
        leaf_[lamps[0]] = node;
        return;
    }
    Vec4 low = lamps_[lamps[0]].centre, high = low;
    for (const std::uint32_t i : lamps)
        low = low.cwiseMin(lamps_[i].centre), high = high.cwiseMax(lamps_[i].centre);
    int axis;
    (high - low).maxCoeff(&axis);
    const auto middle = lamps.size() / 2;
    std::nth_element(lamps.begin(), lamps.begin() + static_cast<std::ptrdiff_t>(middle),
                     lamps.end(), [&](std::uint32_t a, std::uint32_t b) {
                         const double x = lamps_[a].centre[axis], y = lamps_[b].centre[axis];
                         return x != y ? x < y : a < b;
                     });
    const auto first = lamps.first(middle), second = lamps.subspan(middle);
    const std::uint32_t child = add_node(node, first);
    add_node(node, second);
    nodes_[node].child = child;
    split(child, first);
    split(child + 1, second);
}

double Lamps::importance(const Node& node, const Vec4& point, const Vec4& normal) {
    const Vec4 to = node.centre - point;
    const double squared = to.squaredNorm(), radius = node.radius;
    const double distance = std::sqrt(std::max(squared, radius * radius));
    const double far = node.power / (distance * distance * distance);
    if (squared <= radius * radius) return far;
    // The cosine of the direction of the ball that is nearest to the normal.
    const double sine = radius / distance, cosine = std::sqrt((1 - sine) * (1 + sine));
    const double up = std::clamp(normal.dot(to) / distance, -1.0, 1.0);
    if (up >= cosine) return far;
    return far * std::max(0.0, up * cosine + std::sqrt((1 - up) * (1 + up)) * sine);
}

std::optional<LampChoice> Lamps::choose(std::uint32_t k, const Vec4& point, const Vec4& normal,
                                        double chance) const {
    if (nodes_.empty()) return LampChoice{k, 1};
    double probability = 1;
    std::uint32_t node = 0;
    while (nodes_[node].child != kNone) {
        const std::uint32_t child = nodes_[node].child;
        const double first = importance(nodes_[child], point, normal);
        const double both = first + importance(nodes_[child + 1], point, normal);
        if (!(both > 0)) return {};
        const double part = first / both;
        const bool takes_first = chance < part;
        chance = takes_first ? chance / part : (chance - part) / (1 - part);
        chance = std::min(chance, 1 - 1e-16);
        probability *= takes_first ? part : 1 - part;
        node = child + (takes_first ? 0 : 1);
    }
    return LampChoice{lamp_[node], probability};
}

double Lamps::chance_of(std::uint32_t lamp, const Vec4& point, const Vec4& normal) const {
    if (nodes_.empty()) return 1;
    double probability = 1;
    for (std::uint32_t node = leaf_[lamp]; nodes_[node].parent != kNone;) {
        const std::uint32_t child = nodes_[nodes_[node].parent].child;
        const double first = importance(nodes_[child], point, normal);
        const double both = first + importance(nodes_[child + 1], point, normal);
        if (!(both > 0)) return 0;
        const double part = first / both;
        probability *= node == child ? part : 1 - part;
        node = nodes_[node].parent;
    }
    return probability;
}

}  // namespace tesserae::render
