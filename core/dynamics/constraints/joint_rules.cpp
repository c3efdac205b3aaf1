// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/joint_rules.hpp"

#include "core/ranges.hpp"

namespace tesserae {
namespace {

/// The sine of the angle below which two directions count as parallel, usual 1e-7. Smaller: their
/// plane is what rounding makes of it.
constexpr double kParallel = 1e-7;

}  // namespace

bool is_line(JointType type) {
    return type == JointType::kDistance || type == JointType::kRope || type == JointType::kSpring;
}

void complete(JointSpring& spring, FailJoint wrong, FailJoint missing) {
    if (!spring.frequency && !spring.stiffness)
        return missing("frequency", "expected one in Hz, or a stiffness in N/m");
    if (spring.frequency && spring.stiffness)
        wrong("stiffness", "there is a frequency too; expected only one of them");
    if (spring.damping && !spring.frequency)
        wrong("damping", "goes with a frequency; expected damping_force beside a stiffness");
    if (spring.damping_force && !spring.stiffness)
        wrong("damping_force", "goes with a stiffness; expected damping beside a frequency");
    auto& damping = spring.frequency ? spring.damping : spring.damping_force;
    if (!damping) damping = 0;
}

void complete(JointMotor& motor, FailJoint wrong, FailJoint missing) {
    if (!motor.speed && !motor.target) return missing("speed", "expected a speed, or a target");
    if (motor.speed && motor.target)
        wrong("target", "there is a speed too; expected only one of them");
    if (motor.speed) {
        constexpr const char* kOfTarget = "goes with a target, and there is a speed";
        if (motor.frequency) wrong("frequency", kOfTarget);
        if (motor.damping) wrong("damping", kOfTarget);
        return;
    }
    if (!motor.frequency) motor.frequency = kMotorFrequency;
    if (!motor.damping) motor.damping = kMotorDamping;
}

void require_load(const JointBreak& breaks, FailJoint missing) {
    if (!breaks.force && !breaks.torque) missing("force", "expected one in N, or a torque in N m");
}

void require_order(const Vec2& limits, FailJoint wrong) {
    if (!(limits[0] < limits[1])) wrong("limits", "expected [low, high] with low < high");
    if (limits[0] > 0 || limits[1] < 0)
        wrong("limits", "expected limits with 0 between them, where the joint is as placed");
}

void require_span(const JointPlane& plane, FailJoint wrong) {
    for (const Vec4& direction : {plane.first, plane.second})
        if (direction.cwiseAbs().maxCoeff() < kSmallest)
            wrong("plane", "expected two directions, not zero");
    const Vec4 first = stable_normalized(plane.first), second = stable_normalized(plane.second);
    if (!((second - second.dot(first) * first).norm() > kParallel))
        wrong("plane", "the two directions are parallel; expected two that span a plane");
}

}  // namespace tesserae
