#pragma once

#include <span>
#include <vector>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/constants.hpp"

namespace tesserae {

/// What the step needs to know of a body type, worked out once.
struct TypeProperties {
    double mass = 0;           ///< [kg]; 0 if unbounded
    double inverse_mass = 0;   ///< [1/kg]; 0 if the position is fixed
    Bivector inertia;          ///< principal axes, diagonal: I_ij = J_i + J_j [kg m^2]
    Bivector inverse_inertia;  ///< the inverse of each, as contacts see it; 0 if the rotation is
                               ///< fixed, and of a hypersphere without friction, which no contact
                               ///< turns: normals go through its centre
    bool isotropic = true;     ///< all six inverses are equal
    /// A hypersphere that is isotropic: no normal impulse turns it. So is all that contacts do not
    /// move.
    bool round = true;
    bool has_axes = false;  ///< the principal axes are not the body's
    Rotor axes;             ///< from principal axes to the body's
    bool bounded = false;
    bool flat = false;     ///< has nothing but flat faces
    bool has_rim = false;  ///< is a product of balls
    bool movable = false;  ///< contacts can change its motion
    bool fixed = false;    ///< its position or its rotation is
    bool falls = false;    ///< gravity acts on it
    double radius = 0;     ///< of the bounding sphere about the centre [m]
    double arm = 0;        ///< surface speed towards another body per angular speed, at most [m];
                           ///< 0 for a hypersphere, whose turning moves no surface
    double slop = 0;       ///< allowed overlap [m]; infinite if unbounded
    double friction = 0;
    double rolling_friction = 0;  ///< [m]
    double restitution = 0;
};

/// @return one entry for each of bodies.types
std::vector<TypeProperties> type_properties(const Bodies& bodies);

/// Of all of a scene's bodies, for islands that are solved in float.
struct FloatRange {
    /// Masses and sizes leave room in a float for their products: masses within a factor of 2^60,
    /// bounding radii between 1e-9 and 1e9 m, slenderness at most 1e5. Else islands of any size are
    /// solved in double. Slenderness is the largest of a body's inverse inertias over the least, as
    /// contacts see them; 1 where these do not turn it.
    bool fits = true;
    bool slender = false;  ///< any body is: see kSlender
};
FloatRange float_range(std::span<const TypeProperties> types);

/// From a type's principal axes to the world.
inline Rotor principal_rotor(const TypeProperties& type, const Rotor& rotor) {
    return type.has_axes ? rotor * type.axes : rotor;
}

/// An operator on bivectors, component by component: columns are the images of xy, ..., zw. Two
/// rows of zeros make a column two whole vector registers.
using BivectorMap = Eigen::Matrix<double, 8, 6>;

/// The operator that is diagonal in the principal planes, seen from the world: the sum over these
/// of the entry times the plane times itself.
BivectorMap world_map(const Bivector& diagonal, const TypeProperties& type, const Rotor& rotor);

/// What an angular impulse [N m s, world] does to the angular velocity of a body so turned.
Bivector angular_response(const TypeProperties& type, const Rotor& rotor, const Bivector& impulse);

/// Angular momentum about the centre [kg m^2/s, world]: with J the second moments in the world
/// frame it is J omega + omega J.
Bivector angular_momentum(const TypeProperties& type, const Rotor& rotor, const Bivector& omega);

}  // namespace tesserae
