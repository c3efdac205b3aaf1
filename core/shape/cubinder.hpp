// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shape/ball_product.hpp"

namespace tesserae {

/// A Cubinder is a disc in x and y times a rectangle in z and w.
struct Cubinder : BallProduct {
    static constexpr const char* kName = "cubinder";
    static constexpr bool kBounded = true;

    double radius = 1;         ///< [m], > 0
    Vec2 size = Vec2::Ones();  ///< full sides along z and w [m], > 0

    friend bool operator==(const Cubinder& a, const Cubinder& b) {
        return a.radius == b.radius && a.size == b.size;
    }
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        visit({"radius", "m", "The disc in x and y has this radius."}, self.radius,
              Rule::kPositive);
        visit({"size", "m", "The rectangle in z and w has these full sides."}, self.size,
              Rule::kPositive);
    }
};

inline void complete(Cubinder& shape) {
    shape.clear();
    shape.add({1, 1, 0, 0}, shape.radius);
    shape.add({0, 0, 1, 0}, 0.5 * shape.size[0]);
    shape.add({0, 0, 0, 1}, 0.5 * shape.size[1]);
}

}  // namespace tesserae
