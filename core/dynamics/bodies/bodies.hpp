#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "core/body_id.hpp"
#include "core/shape/shape.hpp"

namespace tesserae {

/// Groups of bodies that collide with some groups only.
constexpr int kMostGroups = 64;
constexpr std::uint64_t kAllGroups = ~std::uint64_t{0};

/// The properties that bodies of one type share; all bodies of a lattice are of one type.
struct BodyType {
    Shape shape;
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
