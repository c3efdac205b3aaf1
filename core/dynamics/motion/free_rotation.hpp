// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/bodies/type_properties.hpp"
#include "core/dynamics/step/settings.hpp"

namespace tesserae {

/// The angle by which a body turns in one call of turn_freely(), at most [rad]. A body that is
/// faster is turned by so much only: no step tells its angles apart, and its velocity, which is
/// what acts, stays. It bounds what a turn costs.
constexpr double kMostTurn = 128;

/// Returns for how long a body turns in a call of turn_freely() [s]: h, or until kMostTurn.
double turning_time(const Bivector& omega, double h);

/// Turns a body freely for a time h [s], by at most kMostTurn. Its angular momentum in the world
/// stays, so that its angular velocity changes with the rotor (the gyroscopic term). A body with
/// equal inertia in all planes, or with a fixed rotation, turns at a constant angular velocity,
/// exactly.
///
/// kMidpoint is the implicit midpoint rule for the angular momentum in the body frame. Energy,
/// |L|^2 and L ^ L are quadratic in it and are kept to rounding at any step
/// (FreeRotation.ByMidpointKeepsAllInvariants). The orientation is of second order, and exact where
/// the rotation is steady. Source: Austin, Krishnaprasad, Wang, "Almost Poisson integration of
/// rigid body systems", 1993, here for the two quaternions of Spin(4). kEuler is of first order and
/// keeps |L|^2 and L ^ L only.
/// @param omega   angular velocity, world [rad/s]
void turn_freely(const TypeProperties& type, RotationIntegrator integrator, double h, Rotor& rotor,
                 Bivector& omega);

/// Turns a body freely for a time h [s] that has been limited already: a part of a turn.
void turn_on(const TypeProperties& type, RotationIntegrator integrator, double h, Rotor& rotor,
             Bivector& omega);

/// A body that turns freely.
struct FreeBody {
    const TypeProperties& type;
    Rotor& rotor;
    Bivector& omega;
};
/// Turns two bodies freely, with the same bits as one after the other but in less time.
void turn_freely(const FreeBody& a, const FreeBody& b, RotationIntegrator integrator, double h);

}  // namespace tesserae
