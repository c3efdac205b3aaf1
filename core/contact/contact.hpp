// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "core/body_id.hpp"

namespace tesserae {

/// A Contact is one point where two bodies touch, overlap or are about to touch.
struct Contact {
    Vec4 normal = Vec4::UnitX();  ///< unit, from a to b, world
    Vec4 point = Vec4::Zero();    ///< midway between the two surfaces, world [m]
    double separation = 0;        ///< along the normal [m], negative when overlapping
    BodyId a = 0, b = 0;          ///< a < b
    std::uint32_t feature = 0;    ///< names the point in the pair, while features stay
    /// These say whether the pair is known to touch at no internal edge, as seen from a (bit 0) and
    /// from b (bit 1). It holds while all points of the pair, so many, are there.
    std::uint8_t no_internal_edge = 0, no_internal_edge_points = 0;
};

/// A Pose refers to the position and rotor of a shape. It does not own them.
struct Pose {
    const Vec4& position;  ///< centre, world [m]
    const Rotor& rotor;    ///< body to world
};

/// PairContacts receives the contact points that a pair function finds. The function may be written
/// for the shapes in the other order than the bodies' numbers. It then speaks of its own first and
/// second shape, and the normal is reversed here.
struct PairContacts {
    BodyId a, b;   ///< a < b
    bool swapped;  ///< the function's first shape is b's
    std::vector<Contact>& list;
    /// The bodies of a pair without points are at least this far apart [m], if the function knows
    /// it. It is as accurate as the function's distances.
    double apart = 0;

    /// Appends a point.
    /// @param normal   unit, from the function's first shape to its second
    void add(std::uint32_t feature, const Vec4& normal, double separation, const Vec4& point) {
        list.push_back({swapped ? Vec4(-normal) : normal, point, separation, a, b, feature});
    }
};

}  // namespace tesserae
