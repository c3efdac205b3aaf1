#pragma once

#include <cstddef>
#include <vector>

#include "core/contact/contact.hpp"
#include "core/dynamics/bodies.hpp"
#include "core/dynamics/memory.hpp"
#include "core/dynamics/settings.hpp"
#include "core/dynamics/type_properties.hpp"

namespace tesserae {

/// Items begin <= i < end of a list: what one call of a stage works on. The items of a range do
/// not depend on each other, so that any split gives the same bits.
struct Range {
    std::size_t begin, end;
};

/// A cube about a body's centre that holds all that it can reach in the step. Infinite if
/// unbounded.
struct Bounds {
    Vec4 lower, upper;  ///< world [m]
};

/// Two bodies that may touch in the step, a < b.
struct BodyPair {
    BodyId a, b;

    friend auto operator<=>(const BodyPair&, const BodyPair&) = default;
};

/// Groups of contacts that share movable bodies, numbered by their lowest movable body. Island k
/// has contacts[first[k]] to contacts[first[k + 1]], in the order in which they are solved:
/// ascending (a, b, feature).
struct Islands {
    std::vector<std::uint32_t> first = {0};
    std::vector<std::uint32_t> contacts;  ///< places in the list of contacts

    std::size_t size() const { return first.size() - 1; }
};

/// A contact as the solver sees it. Impulses act on b, their opposites on a.
struct ContactRow {
    Vec4 normal;                ///< unit, from a to b
    Vec4 r_a, r_b;              ///< from the centres to the contact point [m]
    Mat4 tangent_mass;          ///< inverse of the response in the three tangent directions [kg]
    Vec4 tangent_impulse;       ///< [N s], orthogonal to the normal
    double normal_mass = 0;     ///< inverse of the response along the normal [kg]
    double target = 0;          ///< least velocity along the normal [m/s]
    double normal_impulse = 0;  ///< [N s], >= 0
    double friction = 0;        ///< coefficient
    BodyId a = 0, b = 0;
};

/// The bodies as they were after the last finished step, and what is worked out from them once.
struct Simulation {
    Bodies bodies;
    StepMemory memory;
    PhysicsSettings settings;
    std::vector<TypeProperties> types;  ///< by body type

    const TypeProperties& type_of(BodyId id) const { return types[bodies.type[id]]; }
};

/// What the stages of one step hand on. Nothing in it survives the step, its memory does.
struct StepData {
    double dt = 0;  ///< [s]

    std::vector<Vec4> position;  ///< of every body, on its way from the last state to the next
    std::vector<Rotor> rotor;
    std::vector<Vec4> velocity;
    std::vector<Bivector> angular_velocity;

    std::vector<Bounds> bounds;     ///< of every body
    std::vector<BodyPair> pairs;    ///< ascending
    std::vector<Contact> contacts;  ///< ascending (a, b, feature)
    Islands islands;
    std::vector<ContactRow> rows;          ///< in the order of islands.contacts
    std::vector<ContactImpulse> impulses;  ///< of every contact, last step's at first
};

}  // namespace tesserae
