// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/algebra/rotor.hpp"

// A joint as it is asked for: what a [[joint]] table of a scene file says, in metres and radians.
namespace tesserae {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

enum class JointType {
    kPoint,     ///< holds a point of both bodies together; they turn freely
    kDistance,  ///< a rod without mass between two points
    kRope,      ///< the two points come at most so far apart
    kSpring,    ///< pulls and pushes two points to a distance
    kWeld,      ///< holds everything
    kSlider,    ///< leaves the motion along an axis
    kHinge,     ///< leaves the turning in a plane
    kSwivel,    ///< leaves the three turnings that keep an axis
    kGeneral,   ///< leaves any of the ten coordinates
};

/// Two bodies are placed to each other by so many coordinates: distances along the axes x, y, z and
/// w, then angles in the planes xy, xz, xw, yz, yw and zw.
constexpr std::size_t kJointCoordinates = 10;
/// The first of the angles.
constexpr int kFirstAngle = 4;
/// The coordinates that a slider and a hinge leave free.
constexpr int kSliding = 0, kTurning = kFirstAngle;

/// What some of the coordinates have.
template <class T>
using OfCoordinates = std::array<std::optional<T>, kJointCoordinates>;

/// A spring has either a frequency or a stiffness.
struct JointSpring {
    std::optional<double> frequency = {};      ///< [Hz], > 0
    std::optional<double> damping = {};        ///< part of the critical one, >= 0
    std::optional<double> stiffness = {};      ///< [N/m, N m/rad], > 0
    std::optional<double> damping_force = {};  ///< [N s/m, N m s/rad], >= 0
};
/// A motor has either a speed or a target.
struct JointMotor {
    std::optional<double> speed = {};      ///< [m/s, rad/s]
    std::optional<double> target = {};     ///< [m, rad]
    std::optional<double> frequency = {};  ///< of the way to the target [Hz]: as a spring's
    std::optional<double> damping = {};    ///< as a spring's
    std::optional<double> max = {};        ///< greatest force or moment [N, N m], > 0
};
/// How stiffly a motor holds its target, where that is not said: fast for a machine, and without
/// swinging.
constexpr double kMotorFrequency = 5, kMotorDamping = 1;

struct JointBreak {
    std::optional<double> force = {}, torque = {};  ///< [N, N m], > 0
};
/// A plane is turned in from the first direction toward the second.
struct JointPlane {
    Vec4 first = Vec4::UnitX(), second = Vec4::UnitY();
};

/// A joint between bodies as they are placed when it is made. Points and directions are the
/// world's. A type uses some of the members only; the others stay as they are.
struct JointDescription {
    JointType type = JointType::kPoint;
    /// Where the joint is; not for the types between two points, nor for sliders.
    Vec4 anchor = Vec4::Zero();
    /// The two points of a distance, rope or spring; else the bodies' centres.
    std::optional<Vec4> anchor_a = {}, anchor_b = {};
    std::optional<double> length = {};  ///< of these three [m]; else as the points are placed
    Vec4 axis = Vec4::UnitX();          ///< of a slider and a swivel
    JointPlane plane = {};              ///< of a hinge
    Rotor rotation = {};                ///< of the axes of a general joint
    std::uint16_t free = 0;             ///< a bit for each coordinate that a general joint leaves
    JointSpring spring = {};            ///< of a spring
    /// The least and greatest values of free coordinates, around 0 [m, rad].
    OfCoordinates<Vec2> limits = {};
    OfCoordinates<JointSpring> springs = {};  ///< of free coordinates of a general joint
    OfCoordinates<JointMotor> motors = {};    ///< of free coordinates
    std::optional<JointBreak> breaks = {};    ///< it breaks where its load is more than this
    bool collide = false;                     ///< the two bodies touch each other, too
};

}  // namespace tesserae
