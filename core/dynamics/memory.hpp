#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/bodies.hpp"

namespace tesserae {

/// What a contact point's rows ended with: where the next step's solver starts.
struct ContactImpulse {
    BodyId a = 0, b = 0;          ///< a < b
    std::uint32_t feature = 0;    ///< which point of the pair; stays the same while the features do
    double normal = 0;            ///< [N s], >= 0
    Vec4 tangent = Vec4::Zero();  ///< friction impulse on b, world [N s]
};

/// Everything beside the bodies' state that one step leaves to the next and that changes results.
/// Saved with a trajectory so that a resumed run continues bit for bit.
struct StepMemory {
    std::vector<ContactImpulse> impulses;  ///< ascending (a, b, feature)
    double time = 0;  ///< of all steps so far [s]; changes no result, messages name it
};

/// What a step found.
struct StepReport {
    std::uint64_t contacts = 0;  ///< contact points that touch or overlap
    double penetration = 0;      ///< deepest overlap found, in the step's middle [m], >= 0
};

}  // namespace tesserae
