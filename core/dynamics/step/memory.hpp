// SPDX-License-Identifier: Apache-2.0
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
#include "core/dynamics/constraints/wrench.hpp"
#include "core/dynamics/step/kept_impulses.hpp"
#include "core/dynamics/step/report.hpp"

namespace tesserae {

/// A point of a kept manifold.
struct KeptPoint {
    std::array<float, 4> on_a;  ///< on a's surface, from the smaller body's centre, in a's axes [m]
    float separation;           ///< along the normal, when it was found [m]
    std::uint32_t feature;
};
/// The manifold of two bodies that hardly move relative to each other, as it was found in the frame
/// of a with b at `offset` and turned by `rotor`. Only offset and rotor are state; the rest follows
/// from them.
struct KeptManifold {
    enum class Keeps : std::uint8_t { kUnknown, kNormalOfA, kNormalOfB, kNoFace };

    BodyId a = 0, b = 0;  ///< a < b
    Keeps keeps = Keeps::kUnknown;
    std::uint8_t no_internal_edge = 0;       ///< for all points: see Contact
    std::uint8_t count = 0;                  ///< number of points
    PackedVec4 offset = PackedVec4::Zero();  ///< [m]
    Rotor rotor;                             ///< b's frame to a's
    PackedVec4 normal = PackedVec4::Zero();  ///< from a to b when it was found, in a's frame
    std::array<KeptPoint, kManifoldPoints> points = {};

    std::span<const KeptPoint> found() const { return {points.data(), count}; }
};
/// The kept manifolds of a range of pairs. A manifold that is kept from step to step exists once,
/// in both steps' lists, and is not changed. None is created const, so that its memory can be used
/// again.
using KeptManifolds = std::vector<std::shared_ptr<const KeptManifold>>;

/// Everything besides the bodies' state that one step leaves to the next and that changes results.
/// It is saved with a trajectory, so that a resumed run continues bit for bit.
struct StepMemory {
    KeptImpulses impulses;
    /// The angular impulse against rolling and twisting for each of `impulses`, on b, world [N m
    /// s]; empty where there is no rolling friction.
    std::vector<Bivector> angular_impulses;
    std::vector<Wrench> joint_impulses;  ///< of every part of a joint, see Joints; of either sign
    std::vector<std::uint8_t> broken;    ///< of every joint: 1 if it is; empty if none is
    /// For every body the lowest body of the island in which it sleeps, or kAwake; empty where
    /// sleeping is off.
    std::vector<BodyId> asleep;
    std::vector<KeptManifolds> kept;  ///< ascending (a, b), also from list to list
    std::vector<double> still;        ///< how long every body has hardly moved [s], or empty
    double time = 0;                  ///< time of all steps so far [s]; for messages only
};
constexpr BodyId kAwake = std::numeric_limits<BodyId>::max();

}  // namespace tesserae
