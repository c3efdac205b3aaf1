// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/algebra/rotor.hpp"
#include "core/body_id.hpp"
#include "core/shape/shape.hpp"

namespace tesserae {

/// Groups of bodies that collide with some groups only.
constexpr int kMostGroups = 64;
constexpr std::uint64_t kAllGroups = ~std::uint64_t{0};

/// The properties that bodies of one type share; all bodies of a lattice are of one type.
struct BodyType {
    Shape shape = {};
    double mass = 1;              ///< [kg]; unused for unbounded shapes
    double friction = 0.5;        ///< >= 0; a pair uses the geometric mean
    double rolling_friction = 0;  ///< [m], >= 0; a pair uses the larger, if it has friction
    double restitution = 0;       ///< 0 to 1; a pair uses the larger
    bool fixed_position = false;  ///< contacts do not change its velocity, at which it moves
    bool fixed_rotation = false;  ///< contacts do not change its angular velocity
    double gravity_scale = 1;     ///< part of gravity that acts on it, of any sign
    double damping = 0;           ///< [1/s], >= 0: v' = -damping v, and so its angular velocity
    std::uint8_t group = 0;       ///< below kMostGroups
    std::uint64_t collides_with = kAllGroups;  ///< a bit for each group, see collide()

    friend bool operator==(const BodyType&, const BodyType&) = default;
};

/// Returns whether contacts can change the motion of bodies of a type.
inline bool is_movable(const BodyType& type) {
    return is_bounded(type.shape) && !(type.fixed_position && type.fixed_rotation);
}

/// Returns whether bodies of two types collide: each does with the other's group.
/// @tparam Type   BodyType or TypeProperties
template <class Type>
bool collide(const Type& a, const Type& b) {
    return (a.collides_with >> b.group & b.collides_with >> a.group & 1) != 0;
}

/// Where a body is and how it moves.
struct BodyState {
    Vec4 position = Vec4::Zero();    ///< centre, world [m]
    Rotor rotor = {};                ///< body to world, a unit rotor
    Vec4 velocity = Vec4::Zero();    ///< world [m/s]
    Bivector angular_velocity = {};  ///< world [rad/s]
};

}  // namespace tesserae
