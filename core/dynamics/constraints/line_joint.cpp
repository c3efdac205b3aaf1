// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/line_joint.hpp"

namespace tesserae {
namespace {

Vec4 between(const LineJoint& joint, const JointedBody& a, const JointedBody& b) {
    return (b.position + rotate(b.rotor, joint.on_b)) - (a.position + rotate(a.rotor, joint.on_a));
}

}  // namespace

RowVector values_of(const LineJoint& joint, const JointedBody& a, const JointedBody& b,
                    const Rotor&) {
    return RowVector::Constant(1, stable_norm(between(joint, a, b)) - joint.length);
}

Coordinates coordinates_of(const LineJoint& joint, const JointedBody& a, const JointedBody& b) {
    Coordinates all;
    all.size = 1;
    const Vec4 way = between(joint, a, b);
    const double far = stable_norm(way);
    all.values = RowVector::Constant(1, far - joint.length);
    // Any point of the line will do: a force along it has the same moment.
    all.anchor = b.position + rotate(b.rotor, joint.on_b) - 0.5 * way;
    all.rows[0] = {far > 0 ? Vec4(way / far) : Vec4(Vec4::Unit(1)), {}};
    return all;
}

}  // namespace tesserae
