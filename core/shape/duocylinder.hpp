// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shape/ball_product.hpp"

namespace tesserae {

/// A Duocylinder is a disc in x and y times a disc in z and w.
struct Duocylinder : BallProduct {
    static constexpr const char* kName = "duocylinder";
    static constexpr bool kBounded = true;

    Vec2 radii = Vec2::Ones();  ///< of the discs in x, y and in z, w [m], > 0

    friend bool operator==(const Duocylinder& a, const Duocylinder& b) {
        return a.radii == b.radii;
    }
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        visit({"radii", "m",
               "The disc in x and y has the first radius, the disc in z and w the second."},
              self.radii, Rule::kPositive);
    }
};

inline void complete(Duocylinder& shape) {
    shape.clear();
    shape.add({1, 1, 0, 0}, shape.radii[0]);
    shape.add({0, 0, 1, 1}, shape.radii[1]);
}

}  // namespace tesserae
