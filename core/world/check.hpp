// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "core/dynamics/bodies/body.hpp"
#include "core/dynamics/constraints/joint_description.hpp"
#include "core/dynamics/step/settings.hpp"
#include "core/function_ref.hpp"

// The rules of what a World is given. They are those of scene files: see core/ranges.hpp. Every
// error names the place, the value and what was expected.
namespace tesserae {

/// @throws InputError   a number is not finite, or beyond kLargest
void check(std::string_view place, double value);
void check(std::string_view place, const Vec4& value);
void check(std::string_view place, const Bivector& value);

/// @throws InputError   a parameter breaks its Rule
void check(const Shape& shape);
/// Checks the shape, and computes what follows from its parameters.
/// @throws InputError   as check(), and what complete() of the shape says
void make_complete(Shape& shape);
/// @throws InputError   a number of the type, or of its shape, is out of its range
void check(const BodyType& type);
/// @throws InputError   a number is not finite or too large, or the rotor is no rotation
void check(const BodyState& state);
/// @throws InputError   a setting is out of its range
void check(const PhysicsSettings& settings);

/// Says which part of a JointDescription is meant: in C++ joint.motors[4].speed, for example.
struct JointPart {
    std::string_view member;                     ///< such as "motors"
    std::optional<std::size_t> coordinate = {};  ///< of limits, springs and motors
    std::string_view key = {};                   ///< of springs, motors, breaks and planes
};
/// Returns what an error calls a part.
using NameOfPart = FunctionRef<std::string(const JointPart& part)>;

/// Checks a joint, and sets the defaults of its springs and motors.
/// @param name   of parts, in the language in which the joint was described; without it in C++
/// @throws InputError   a number is out of its range; two of which only one may be there are there;
///                      one is missing
void complete(JointDescription& joint, NameOfPart name);
void complete(JointDescription& joint);

}  // namespace tesserae
