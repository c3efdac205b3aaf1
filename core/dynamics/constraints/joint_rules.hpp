// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "core/dynamics/constraints/joint_description.hpp"
#include "core/function_ref.hpp"

// What joints are called, and what holds of them wherever they are described: in a scene file, in
// C++ or in Python.
namespace tesserae {

/// The name of each JointType, in their order.
constexpr std::array<std::string_view, 9> kJointTypeNames = {
    "point", "distance", "rope", "spring", "weld", "slider", "hinge", "swivel", "general"};

/// The name of each coordinate, in their order.
constexpr std::array<std::string_view, kJointCoordinates> kCoordinateNames = {
    "x", "y", "z", "w", "xy", "xz", "xw", "yz", "yw", "zw"};

/// Returns whether joints of a type are between two points: distances, ropes and springs.
bool is_line(JointType type);

/// Is called with the member of a description that is wrong, or missing, and with what is wrong or
/// expected. It throws, or keeps the error for later.
using FailJoint = FunctionRef<void(const char* member, std::string_view what)>;

/// Checks which numbers of a spring are there, and sets the defaults of the others.
void complete(JointSpring& spring, FailJoint wrong, FailJoint missing);
/// Checks which numbers of a motor are there, and sets the defaults of the others.
void complete(JointMotor& motor, FailJoint wrong, FailJoint missing);
/// Checks that a force or a torque is there.
void require_load(const JointBreak& breaks, FailJoint missing);
/// Checks that limits are in order and have 0 between them.
void require_order(const Vec2& limits, FailJoint wrong);
/// Checks that the two directions span a plane.
void require_span(const JointPlane& plane, FailJoint wrong);

}  // namespace tesserae
