// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "core/algebra/rotor.hpp"
#include "core/body_id.hpp"
#include "core/dynamics/constraints/constraint.hpp"

namespace tesserae {

struct Bodies;

/// Where a body is and how it moves, for a joint. The default is the world, which stands still.
struct JointedBody {
    Vec4 position = Vec4::Zero();  ///< [m]
    Rotor rotor;
    Vec4 velocity = Vec4::Zero();  ///< [m/s]
    Bivector angular_velocity;     ///< [rad/s]
};

/// Returns where a body is; the world for kWorld.
JointedBody placed(const Bodies& bodies, BodyId id);
/// Returns where a body is after it went straight on and turned freely for a time [s].
JointedBody moved_on(const JointedBody& body, double time);
/// Returns a point or direction of the world in a body's axes, from its centre.
Vec4 point_in(const JointedBody& body, const Vec4& point);

/// The coordinates of a kind of joint: numbers that tell where body b is relative to body a. A
/// joint holds, limits or drives each of them. The derivative of a coordinate is the velocity of
/// its row.
struct Coordinates {
    int size = 0;
    RowVector values;            ///< [m, rad]
    Rotor turn;                  ///< of b relative to a, from which the angles are
    Vec4 anchor = Vec4::Zero();  ///< where the rows act, world [m]
    std::array<Wrench, kMostRows> rows;
};

}  // namespace tesserae
