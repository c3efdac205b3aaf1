// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "core/dynamics/bodies/body.hpp"
#include "core/dynamics/constraints/joint_description.hpp"
#include "core/dynamics/step/settings.hpp"

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
/// Checks a joint, and sets the defaults of its springs and motors.
/// @throws InputError   a number is out of its range; two of which only one may be there are there;
///                      one is missing
void complete(JointDescription& joint);

}  // namespace tesserae
