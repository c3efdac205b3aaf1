#pragma once

#include <cstdint>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "core/body_id.hpp"

namespace tesserae {

/// One point where two bodies touch, overlap, or are about to.
struct Contact {
    Vec4 normal = Vec4::UnitX();  ///< unit, from a to b, world
    Vec4 point = Vec4::Zero();    ///< midway between the two surfaces, world [m]
    double separation = 0;        ///< along the normal [m], negative when overlapping
    BodyId a = 0, b = 0;          ///< a < b
    std::uint32_t feature = 0;    ///< which point of the pair; stays the same while features do
    /// Known beforehand of the pair: seen from a (bit 0) or b (bit 1) it is no internal edge, as
    /// long as all its points, so many, are there.
    std::uint8_t no_internal_edge = 0, no_internal_edge_points = 0;
};

/// Where a shape is: seen, not kept.
struct Pose {
    const Vec4& position;  ///< centre, world [m]
    const Rotor& rotor;    ///< body to world
};

/// Where a pair's function puts the points it finds. The function may be written for the shapes in
/// the other order than the bodies' numbers: then it speaks of its own first and second shape, and
/// the normal is turned round here.
struct PairContacts {
    BodyId a, b;   ///< a < b
    bool swapped;  ///< the function's first shape is b's
    std::vector<Contact>& list;
    /// Of a pair without points that its function knows more of: how far apart the bodies are at
    /// least [m], as true as the function's distances.
    double apart = 0;

    /// @param normal  unit, from the function's first shape to its second
    void add(std::uint32_t feature, const Vec4& normal, double separation, const Vec4& point) {
        list.push_back({swapped ? Vec4(-normal) : normal, point, separation, a, b, feature});
    }
};

}  // namespace tesserae
