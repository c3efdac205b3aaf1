// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/constraints/joint.hpp"

namespace tesserae {

/// What a joint is and does after a step.
struct JointState {
    double impulse = 0;          ///< size of the impulse between the bodies in the step [N s]
    double angular_impulse = 0;  ///< and of the moment's about the joint's anchor [N m s]
    double error = 0;            ///< how far held points are apart [m]
    double angular_error = 0;    ///< by what angle held directions are off [rad]
    double position = 0;         ///< of its one free coordinate [m, rad]; NaN if it has not one
};

/// Returns the state of a joint.
/// @param impulse   see Stepper::joint_impulses()
JointState state_of(const Joint& joint, const Bodies& bodies, const Wrench& impulse);

/// Returns the one coordinate of a joint that it does not hold; -1 if there are none or several.
int free_coordinate(const Joint& joint);
/// Returns whether a coordinate of a joint is an angle.
bool is_angle(const Joint& joint, int coordinate);

}  // namespace tesserae
