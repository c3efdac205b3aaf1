// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "core/dynamics/bodies/body.hpp"

namespace tesserae {

/// All bodies of a scene: their types, and their state as a structure of arrays indexed by BodyId.
/// Bodies of unbounded shapes are fixed at the origin with the identity rotor.
struct Bodies {
    std::vector<BodyType> types;
    std::vector<std::uint32_t> type;         ///< index into types
    std::vector<Vec4> position;              ///< centre, world [m]
    std::vector<Rotor> rotor;                ///< body to world
    std::vector<Vec4> velocity;              ///< world [m/s]
    std::vector<Bivector> angular_velocity;  ///< world [rad/s]

    std::size_t size() const { return type.size(); }
    const BodyType& type_of(BodyId id) const { return types[type[id]]; }
    /// Returns whether contacts can change the motion of a body.
    bool is_movable(BodyId id) const { return tesserae::is_movable(type_of(id)); }
};

/// Interpolates poses between two states of the same bodies: positions linearly, rotors along the
/// shortest way.
/// @param part      part of the way from `before` to `after`, 0 to 1
/// @param between   gets the positions and rotors, the rest of it stays; may be `before`
void interpolate_poses(const Bodies& before, const Bodies& after, double part, Bodies& between);

/// The turning of a body from one state to a later one. It turns at the mean of both angular
/// velocities, possibly many times round. What this leaves to the later rotor it turns in addition,
/// by the shortest way.
struct Turning {
    Rotor begin;
    Bivector half_angle;  ///< exp(-half_angle) is the turning by the velocities
    Bivector rest;        ///< exp(rest) is the remaining turning

    /// Returns the rotor at a part of the way, 0 to 1.
    Rotor at(double part) const { return exp(part * rest) * exp(-part * half_angle) * begin; }
};

/// Returns the turning of a body between two states, or none if its rotor is the same in both.
/// @param time   from `before` to `after` [s]
std::optional<Turning> turning(const Bodies& before, const Bodies& after, double time, BodyId id);

}  // namespace tesserae
