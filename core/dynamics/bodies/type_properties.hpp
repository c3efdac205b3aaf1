// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/constants.hpp"

namespace tesserae {

/// The numbers of a body type that the step needs, computed once.
struct TypeProperties {
    double mass = 0;           ///< [kg]; 0 if unbounded
    double inverse_mass = 0;   ///< [1/kg]; 0 if the position is fixed
    Bivector inertia;          ///< principal axes, diagonal: I_ij = J_i + J_j [kg m^2]
    Bivector inverse_inertia;  ///< the inverses that contacts act by; 0 if the rotation is fixed,
                               ///< and for a hypersphere without friction or joints: normals go
                               ///< through its centre and turn nothing
    bool isotropic = true;     ///< all six inverses are equal
    /// True for an isotropic hypersphere, which no normal impulse turns, and for all that contacts
    /// do not move.
    bool round = true;
    bool has_axes = false;  ///< the principal axes differ from the body's
    Rotor axes;             ///< from principal axes to the body's
    bool bounded = false;
    bool flat = false;           ///< has flat faces only
    bool has_rim = false;        ///< is a product of balls
    bool movable = false;        ///< contacts can change its motion
    bool fixed = false;          ///< its position or its rotation is fixed
    double gravity_scale = 0;    ///< part of gravity that acts on it; 0 if the position is fixed
    double damping = 0;          ///< of its velocity [1/s]; 0 if the position is fixed
    double angular_damping = 0;  ///< of its angular velocity [1/s]; 0 if the rotation is fixed
    std::uint8_t group = 0;
    std::uint64_t collides_with = kAllGroups;  ///< a bit for each group
    double radius = 0;                         ///< of the bounding sphere about the centre [m]
    double arm = 0;  ///< greatest surface speed towards another body per angular speed [m]; 0 for a
                     ///< hypersphere
    double slop = 0;  ///< allowed overlap [m]; infinite if unbounded
    /// Its numbers fit in floats, in which coloured islands are solved: its bounding radius is
    /// between 1e-9 and 1e9 m, its slenderness at most 1e5. The slenderness is the largest inverse
    /// inertia over the least, of those that contacts act by; 1 if contacts do not turn it.
    bool fits_floats = true;
    double friction = 0;
    double rolling_friction = 0;  ///< [m]
    double restitution = 0;
};

/// Returns the properties of each of bodies.types.
/// @param jointed   bodies that have joints, or that something else besides contacts may turn
std::vector<TypeProperties> type_properties(const Bodies& bodies,
                                            std::span<const BodyId> jointed = {});

/// Returns the rotor from a type's principal axes to the world.
inline Rotor principal_rotor(const TypeProperties& type, const Rotor& rotor) {
    return type.has_axes ? rotor * type.axes : rotor;
}

/// A linear map of bivectors: its columns are the images of xy, ..., zw. Two rows of zeros make a
/// column fill two vector registers.
using BivectorMap = Eigen::Matrix<double, 8, 6>;

/// Returns, in world axes, the map that is diagonal in the principal planes: the sum over these of
/// the entry times the plane's tensor product with itself.
BivectorMap world_map(const Bivector& diagonal, const TypeProperties& type, const Rotor& rotor);

/// Returns the change of angular velocity by an angular impulse [N m s, world] of a body with this
/// rotor.
Bivector angular_response(const TypeProperties& type, const Rotor& rotor, const Bivector& impulse);

/// Returns the angular momentum about the centre [kg m^2/s, world]: J omega + omega J, with J the
/// second moments in the world frame.
Bivector angular_momentum(const TypeProperties& type, const Rotor& rotor, const Bivector& omega);

}  // namespace tesserae
