// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/coordinates.hpp"

#include "core/dynamics/bodies/bodies.hpp"

namespace tesserae {

JointedBody placed(const Bodies& bodies, BodyId id) {
    if (id == kWorld) return {};
    return {bodies.position[id], bodies.rotor[id], bodies.velocity[id],
            bodies.angular_velocity[id]};
}

JointedBody moved_on(const JointedBody& body, double time) {
    return {body.position + time * body.velocity,
            exp(-0.5 * time * body.angular_velocity) * body.rotor, body.velocity,
            body.angular_velocity};
}

Vec4 point_in(const JointedBody& body, const Vec4& point) {
    return to_matrix(body.rotor).transpose() * (point - body.position);
}

}  // namespace tesserae
