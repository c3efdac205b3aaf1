// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/algebra/rotor.hpp"
#include "core/body_id.hpp"

// What a World tells.
namespace tesserae {

/// A joint's number.
using JointId = std::uint32_t;

/// The state of all bodies as arrays. They are the world's own memory: after a step they show the
/// new state. Once bodies are added or removed they show the last state before that, and the memory
/// stays as long as this object does.
struct BodyArrays {
    std::span<const Vec4> position;              ///< centres, world [m]
    std::span<const Rotor> rotor;                ///< body to world
    std::span<const Vec4> velocity;              ///< world [m/s]
    std::span<const Bivector> angular_velocity;  ///< world [rad/s]
    std::shared_ptr<const void> memory;          ///< keeps the arrays alive
};

/// A point where two bodies touch.
struct ContactReading {
    BodyId a = 0, b = 0;           ///< a < b
    Vec4 point = Vec4::Zero();     ///< midway between the surfaces, world [m]
    Vec4 normal = Vec4::Zero();    ///< unit, from a to b, world
    double separation = 0;         ///< along the normal [m], negative in overlap
    double impulse = 0;            ///< on b along the normal, of the last sub-step [N s], >= 0
    Vec4 friction = Vec4::Zero();  ///< friction's impulse on b while it rests, world [N s]
};

/// Two bodies that touch, a < b.
struct TouchingPair {
    BodyId a = 0, b = 0;

    friend auto operator<=>(const TouchingPair&, const TouchingPair&) = default;
};
/// The pairs that began and ended to touch, each ascending.
struct ContactChanges {
    std::vector<TouchingPair> began, ended;
};

/// What a joint is and did in the last step.
struct JointReading {
    BodyId a = 0, b = 0;         ///< b may be kWorld
    bool broken = false;         ///< its load was too much: it holds nothing any more
    double impulse = 0;          ///< between the bodies, in the last step [N s]
    double angular_impulse = 0;  ///< about the anchor [N m s]
    double error = 0;            ///< how far held points are apart [m]
    double angular_error = 0;    ///< by what angle held directions are off [rad]
    double position = 0;         ///< of its one free coordinate [m, rad]; NaN if it has not one
};

/// Where a ray meets a body.
struct RayHit {
    BodyId body = 0;
    double distance = 0;         ///< from the origin [m]
    Vec4 point = Vec4::Zero();   ///< world [m]
    Vec4 normal = Vec4::Zero();  ///< unit, outward, world
};

/// The body that is nearest to a point.
struct Nearest {
    BodyId body = 0;
    double distance = 0;         ///< of its surface [m], negative inside
    Vec4 point = Vec4::Zero();   ///< on its surface, world [m]
    Vec4 normal = Vec4::Zero();  ///< unit, outward, world
};

}  // namespace tesserae
