// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shape/ball_product.hpp"

namespace tesserae {

/// A Spherinder is a three-dimensional ball in x, z and w times a segment along y.
struct Spherinder : BallProduct {
    static constexpr const char* kName = "spherinder";
    static constexpr bool kBounded = true;

    double radius = 1;  ///< of the ball [m], > 0
    double height = 1;  ///< of the segment [m], > 0

    friend bool operator==(const Spherinder& a, const Spherinder& b) {
        return a.radius == b.radius && a.height == b.height;
    }
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        visit({"radius", "m", "The ball in x, z and w has this radius."}, self.radius,
              Rule::kPositive);
        visit({"height", "m", "The body is this long along y."}, self.height, Rule::kPositive);
    }
};

inline void complete(Spherinder& shape) {
    shape.clear();
    shape.add({1, 0, 1, 1}, shape.radius);
    shape.add({0, 1, 0, 0}, 0.5 * shape.height);
}

}  // namespace tesserae
