// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"

namespace tesserae {

/// A tree of 4D boxes over the bounding balls of all bounded bodies: what a query meets is found in
/// a time that grows with the logarithm of their number.
class BallTree {
  public:
    struct Box {
        Vec4 low = Vec4::Constant(std::numeric_limits<double>::infinity());
        Vec4 high = Vec4::Constant(-std::numeric_limits<double>::infinity());

        /// Returns the distance of a point [m], 0 inside.
        double distance(const Vec4& point) const {
            return (low - point).cwiseMax(point - high).cwiseMax(0).norm();
        }
        /// Returns where a ray enters, 0 if it begins inside, infinity if it misses.
        /// @param inverse   1 / direction, by component
        double entry(const Vec4& origin, const Vec4& inverse) const;
    };

    BallTree() = default;
    explicit BallTree(const Bodies& bodies);

    /// Calls visit(body) for the bodies in all boxes whose bound(box) is at most limit(), the
    /// nearest boxes first. Either may change while the tree is walked.
    template <class Bound, class Limit, class Visit>
    void walk(const Bound& bound, const Limit& limit, const Visit& visit) const {
        if (nodes_.empty()) return;
        std::vector<std::pair<double, std::uint32_t>> waiting = {{bound(nodes_[0].box), 0}};
        while (!waiting.empty()) {
            const auto [nearest, number] = waiting.back();
            waiting.pop_back();
            if (!(nearest <= limit())) continue;
            const Node& node = nodes_[number];
            if (node.child == 0) {
                for (std::uint32_t i = node.begin; i < node.end; ++i) visit(order_[i]);
                continue;
            }
            std::pair near = {bound(nodes_[node.child].box), node.child};
            std::pair far = {bound(nodes_[node.child + 1].box), node.child + 1};
            if (far.first < near.first) std::swap(near, far);
            waiting.push_back(far);
            waiting.push_back(near);
        }
    }

    /// Returns the bodies that no box holds.
    const std::vector<BodyId>& unbounded() const { return unbounded_; }

  private:
    struct Node {
        Box box;
        std::uint32_t begin, end;  ///< its bodies in order_
        std::uint32_t child;       ///< the first of two that follow each other; 0 in a leaf
    };

    void split(std::uint32_t number, const Bodies& bodies, const std::vector<double>& radii);

    std::vector<Node> nodes_;
    std::vector<BodyId> order_, unbounded_;
};

}  // namespace tesserae
