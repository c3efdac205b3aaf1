// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/diagnostics/joint_state.hpp"

#include <cmath>
#include <limits>

namespace tesserae {

bool is_angle(const Joint& joint, int coordinate) {
    return std::holds_alternative<FrameJoint>(joint.kind) && coordinate >= 4;
}

int free_coordinate(const Joint& joint) {
    int free = -1;
    for (int i = 0; i < size_of(joint); ++i) {
        if ((joint.held >> i & 1) != 0) continue;
        if (free >= 0) return -1;
        free = i;
    }
    return free;
}

JointState state_of(const Joint& joint, const Bodies& bodies, const Wrench& impulse) {
    const Coordinates coordinates = coordinates_of(joint, bodies);
    JointState state;
    state.impulse = impulse.impulse.norm();
    state.angular_impulse = norm(impulse.moment);
    state.position = std::numeric_limits<double>::quiet_NaN();
    double squared = 0, angles_squared = 0;
    for (int i = 0; i < coordinates.size; ++i) {
        if ((joint.held >> i & 1) == 0) continue;
        const double value = coordinates.values[i];
        (is_angle(joint, i) ? angles_squared : squared) += value * value;
    }
    state.error = std::sqrt(squared);
    state.angular_error = std::sqrt(angles_squared);
    if (const int free = free_coordinate(joint); free >= 0)
        state.position = coordinates.values[free];
    return state;
}

}  // namespace tesserae
