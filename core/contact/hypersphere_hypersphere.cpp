// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hypersphere_hypersphere.hpp"

namespace tesserae {

void contacts_between(const Hypersphere& a, const Pose& pose_a, const Hypersphere& b,
                      const Pose& pose_b, double margin, PairContacts& out) {
    const Vec4 between = pose_b.position - pose_a.position;
    const double distance = between.norm();
    const double separation = distance - (a.radius + b.radius);
    if (!(separation <= margin)) return;
    const Vec4 normal = distance > kCoincident ? Vec4(between / distance) : Vec4::UnitX();
    out.add(0, normal, separation, pose_a.position + (a.radius + 0.5 * separation) * normal);
}

}  // namespace tesserae
