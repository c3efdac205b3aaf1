#include "core/dynamics/constraints/point_joint.hpp"

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

RowErrors pose(const PointJoint& joint, const StepData& step, Constraint& constraint) {
    const BodyId a = constraint.a, b = constraint.b;
    const Vec4 r_a = to_matrix(step.rotor[a]) * joint.on_a;
    const Vec4 r_b = to_matrix(step.rotor[b]) * joint.on_b;
    const Vec4 on_a = step.position[a] + r_a, on_b = step.position[b] + r_b;
    // Both impulses act at one place: else they would turn the bodies together.
    const Vec4 anchor = 0.5 * (on_a + on_b);
    constraint.r_a = anchor - step.position[a];
    constraint.r_b = anchor - step.position[b];
    constraint.size = 4;
    for (int axis = 0; axis < 4; ++axis)
        constraint.rows[static_cast<std::size_t>(axis)] = {Vec4::Unit(axis), {}};
    const auto bend = [&](BodyId id, const Vec4& r) {
        return velocity_at(step.angular_velocity[id], velocity_at(step.angular_velocity[id], r));
    };
    return {on_b - on_a, bend(b, r_b) - bend(a, r_a)};
}

}  // namespace tesserae
