// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/shape/hull_shape.hpp"

namespace tesserae {

/// A Duoprism is a regular polygon in x and y, with a vertex on +x, times one in z and w, with a
/// vertex on +z.
struct Duoprism : HullShape {
    static constexpr const char* kName = "duoprism";
    static constexpr bool kBounded = true;
    /// A duoprism has at most so many vertices, the product of the two numbers of sides.
    static constexpr std::int64_t kMostVertices = 1000;

    std::array<std::int64_t, 2> polygons = {4, 4};  ///< numbers of sides, >= 3
    Vec2 radii = Vec2::Ones();                      ///< circumradii [m], > 0

    friend bool operator==(const Duoprism& a, const Duoprism& b) {
        return a.polygons == b.polygons && a.radii == b.radii;
    }
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        visit({"polygons", "",
               "The polygon in x and y has the first number of sides and a corner on +x; the one "
               "in z and w has the second and a corner on +z."},
              self.polygons, Rule::kSides);
        visit({"radii", "m", "The corners of the two polygons are this far from their centres."},
              self.radii, Rule::kPositive);
    }
};

/// Makes the hull from the parameters.
/// @throws InputError   as hull_of(), and for more than kMostVertices
void complete(Duoprism&);

}  // namespace tesserae
