// SPDX-License-Identifier: Apache-2.0
#include "core/world/ball_tree.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae {
namespace {

/// The most bodies of a leaf, usual 4: more are tested in vain, fewer make more nodes.
constexpr std::uint32_t kLeaf = 4;

}  // namespace

double BallTree::Box::entry(const Vec4& origin, const Vec4& inverse) const {
    double enter = 0, leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 4; ++axis) {
        if (std::isinf(inverse[axis])) {  // along the sides: in between, or never
            if (origin[axis] < low[axis] || origin[axis] > high[axis])
                return std::numeric_limits<double>::infinity();
            continue;
        }
        const double a = (low[axis] - origin[axis]) * inverse[axis];
        const double b = (high[axis] - origin[axis]) * inverse[axis];
        enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

BallTree::BallTree(const Bodies& bodies) {
    std::vector<double> radius_of_type;
    for (const BodyType& type : bodies.types) radius_of_type.push_back(bounding_radius(type.shape));
    std::vector<double> radii(bodies.size());
    for (BodyId id = 0; id < bodies.size(); ++id) {
        radii[id] = radius_of_type[bodies.type[id]];
        (std::isfinite(radii[id]) ? order_ : unbounded_).push_back(id);
    }
    if (order_.empty()) return;
    nodes_.push_back({{}, 0, static_cast<std::uint32_t>(order_.size()), 0});
    for (std::uint32_t number = 0; number < nodes_.size(); ++number) split(number, bodies, radii);
}

/// Sets a node's box, and halves the node at the middle of its widest axis if it is no leaf.
void BallTree::split(std::uint32_t number, const Bodies& bodies, const std::vector<double>& radii) {
    Node node = nodes_[number];
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const BodyId id = order_[i];
        // A ray that grazes the ball must not miss the box by a rounding.
        const double reach = radii[id] * (1 + 1e-12) + 1e-12 * bodies.position[id].norm();
        node.box.low = node.box.low.cwiseMin((bodies.position[id].array() - reach).matrix());
        node.box.high = node.box.high.cwiseMax((bodies.position[id].array() + reach).matrix());
    }
    if (node.end - node.begin > kLeaf) {
        Eigen::Index axis = 0;
        (node.box.high - node.box.low).maxCoeff(&axis);
        const std::uint32_t middle = (node.begin + node.end) / 2;
        std::nth_element(order_.begin() + node.begin, order_.begin() + middle,
                         order_.begin() + node.end, [&](BodyId a, BodyId b) {
                             const double at_a = bodies.position[a][axis];
                             const double at_b = bodies.position[b][axis];
                             return at_a != at_b ? at_a < at_b : a < b;
                         });
        node.child = static_cast<std::uint32_t>(nodes_.size());
        nodes_.push_back({{}, node.begin, middle, 0});
        nodes_.push_back({{}, middle, node.end, 0});
    }
    nodes_[number] = node;
}

}  // namespace tesserae
