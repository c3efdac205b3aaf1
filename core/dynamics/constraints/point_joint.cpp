// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/point_joint.hpp"

namespace tesserae {

RowVector values_of(const PointJoint& joint, const JointedBody& a, const JointedBody& b,
                    const Rotor&) {
    return (b.position + rotate(b.rotor, joint.on_b)) - (a.position + rotate(a.rotor, joint.on_a));
}

Coordinates coordinates_of(const PointJoint& joint, const JointedBody& a, const JointedBody& b) {
    Coordinates all;
    all.size = 4;
    const Vec4 on_a = a.position + rotate(a.rotor, joint.on_a);
    const Vec4 on_b = b.position + rotate(b.rotor, joint.on_b);
    all.values = on_b - on_a;
    // Both impulses act at one place: else they would turn the bodies together.
    all.anchor = 0.5 * (on_a + on_b);
    for (int axis = 0; axis < 4; ++axis)
        all.rows[static_cast<std::size_t>(axis)] = {Vec4::Unit(axis), {}};
    return all;
}

}  // namespace tesserae
