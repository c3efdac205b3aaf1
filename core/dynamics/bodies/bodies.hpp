#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "core/body_id.hpp"
#include "core/shape/shape.hpp"

namespace tesserae {

/// What bodies of one kind share (all bodies of a lattice are of one type).
struct BodyType {
    Shape shape;
    double mass = 1;              ///< [kg]; unused for unbounded shapes
    double friction = 0.5;        ///< >= 0; a pair uses the geometric mean
    double rolling_friction = 0;  ///< [m], >= 0; a pair uses the larger, if it has friction
    double restitution = 0;       ///< 0 to 1; a pair uses the larger
    bool fixed_position = false;  ///< contacts do not change its velocity (it moves at it)
    bool fixed_rotation = false;  ///< contacts do not change its angular velocity

    friend bool operator==(const BodyType&, const BodyType&) = default;
};

/// Contacts can change the motion of its bodies.
inline bool is_movable(const BodyType& type) {
    return is_bounded(type.shape) && !(type.fixed_position && type.fixed_rotation);
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
    /// Contacts can change its motion.
    bool is_movable(BodyId id) const { return tesserae::is_movable(type_of(id)); }
};

/// Positions and rotors on the way from `before` to `after`, those of the same bodies later:
/// positions linearly, rotors along the shortest way.
/// @param part      0 to 1 of the way
/// @param between   gets them, the rest of it stays; may be `before`
void interpolate_poses(const Bodies& before, const Bodies& after, double part, Bodies& between);

/// How a body turns from one state to a later one: at the mean of both angular velocities, however
/// many times round; what that leaves to the later rotor it turns the shortest way meanwhile.
struct Turning {
    Rotor begin;
    Bivector half_angle;  ///< exp(-half_angle) turns by the velocities
    Bivector rest;        ///< exp(rest) turns by what they leave

    /// @param part   0 to 1 of the way
    Rotor at(double part) const { return exp(part * rest) * exp(-part * half_angle) * begin; }
};

/// @param time   from `before` to `after` [s]
/// @return none where the rotor is the same in both
std::optional<Turning> turning(const Bodies& before, const Bodies& after, double time, BodyId id);

}  // namespace tesserae
