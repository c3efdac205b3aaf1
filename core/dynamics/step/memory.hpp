#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "core/contact/manifold.hpp"
#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/step/kept_impulses.hpp"

namespace tesserae {

struct KeptPoint {
    std::array<float, 4> on_a;  ///< on a's surface, from the smaller body's centre, in a's axes [m]
    float separation;           ///< where it was found, along the normal [m]
    std::uint32_t feature;
};
/// The manifold of two bodies that hardly move against each other, as it was found in the frame of
/// a where b was at `offset` and turned by `rotor`. That alone is state; the rest follows from it.
struct KeptManifold {
    enum class Keeps : std::uint8_t { kUnknown, kNormalOfA, kNormalOfB, kNoFace };

    BodyId a = 0, b = 0;  ///< a < b
    Keeps keeps = Keeps::kUnknown;
    std::uint8_t no_internal_edge = 0;       ///< with all points: see Contact
    std::uint8_t count = 0;                  ///< of the points
    PackedVec4 offset = PackedVec4::Zero();  ///< [m]
    Rotor rotor;                             ///< b's frame to a's
    PackedVec4 normal = PackedVec4::Zero();  ///< from a to b where it was found, in a's frame
    std::array<KeptPoint, kManifoldPoints> points = {};

    std::span<const KeptPoint> found() const { return {points.data(), count}; }
};
/// Those of a range of pairs. What is kept from step to step is there once, in both steps' lists,
/// and is not changed; none is made as a constant, so that its memory can be used again.
using KeptManifolds = std::vector<std::shared_ptr<const KeptManifold>>;

/// Everything beside the bodies' state that one step leaves to the next and that changes results.
/// Saved with a trajectory so that a resumed run continues bit for bit.
struct StepMemory {
    KeptImpulses impulses;
    /// Of each of `impulses` what held rolling and twisting, on b, world [N m s]; empty where there
    /// is no rolling friction.
    std::vector<Bivector> angular_impulses;
    /// Of every body, or empty where sleeping is off: the lowest body of the island that it sleeps
    /// in, or kAwake.
    std::vector<BodyId> asleep;
    std::vector<KeptManifolds> kept;  ///< ascending (a, b), from list to list too
    std::vector<double> still;        ///< how long every body has hardly moved [s], or empty
    double time = 0;  ///< of all steps so far [s]; changes no result, messages name it
};
constexpr BodyId kAwake = std::numeric_limits<BodyId>::max();

/// What a step found, in the middle of its last sub-step. Contacts of bodies that sleep count, as
/// they were when they fell asleep, but their overlap does not.
struct StepReport {
    std::uint64_t contacts = 0;   ///< contact points that touch or overlap
    double penetration = 0;       ///< deepest overlap [m], >= 0
    double mean_penetration = 0;  ///< overlap of those that touch or overlap, on average [m], >= 0
    double residual = 0;  ///< largest change of a contact's normal velocity that the solver still
                          ///< made in its last iteration [m/s]
    std::uint64_t asleep = 0;  ///< bodies
};

}  // namespace tesserae
