// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/bodies/type_properties.hpp"

namespace tesserae {

/// The parts of a step that a scene needs, decided once for all steps. A part that is false is left
/// out of every step, which has the same result (Needs.WhatIsLeftOutWouldChangeNothing).
struct Needs {
    bool friction = true;    ///< tangent rows: a movable body has friction
    bool very_rough = true;  ///< search for pairs without conjugate directions: a body has more
                             ///< friction than kMostConjugateFriction
    bool rolling = true;  ///< rolling rows: some body has rolling friction, and friction can turn
                          ///< some body; needs turning
    bool restitution = true;     ///< rebounds: a body has restitution
    bool uneven_inertia = true;  ///< 6x6 inertia: some movable body is not isotropic
    bool internal_edges = true;  ///< faces that may lie in one plane: a bounded body has faces
    bool rims = true;       ///< aims of rims: some body is a product of balls, and some body turns
    bool manifolds = true;  ///< kept manifolds: two bodies have flat faces only
    bool turning = true;    ///< rotors and angular velocities: some body turns, or contacts
                            ///< can turn it
    bool damping = true;    ///< damped velocities: the motion of some body is damped
};

/// Returns what the steps of these bodies need.
Needs needs_of(const Bodies& bodies, std::span<const TypeProperties> types);

}  // namespace tesserae
