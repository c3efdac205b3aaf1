#pragma once

#include <span>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/bodies/type_properties.hpp"

namespace tesserae {

/// What the steps of a scene need, decided once for all of them. What is false is left out of every
/// step, which then has the same result (Needs.WhatIsLeftOutWouldChangeNothing).
struct Needs {
    bool friction = true;        ///< tangent rows: a movable body has friction
    bool very_rough = true;      ///< a look for pairs whose loads have no conjugate directions: a
                                 ///< body has more friction than kMostConjugateFriction
    bool rolling = true;         ///< rows against rolling and twisting: some body has rolling
                                 ///< friction, and friction can turn some body; needs turning
    bool restitution = true;     ///< rebounds: a body has restitution
    bool uneven_inertia = true;  ///< 6x6 inertia: some movable body's depends on the direction
    bool internal_edges = true;  ///< faces that may lie in one plane: a bounded body has faces
    bool rims = true;            ///< where they go: some body is a product of balls, and some turns
    bool manifolds = true;       ///< kept ones: two bodies have nothing but flat faces
    bool turning = true;         ///< rotors and angular velocities: some body turns, or contacts
                                 ///< can turn it
};

Needs needs_of(const Bodies& bodies, std::span<const TypeProperties> types);

}  // namespace tesserae
