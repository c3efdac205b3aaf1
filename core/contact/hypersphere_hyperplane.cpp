// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hypersphere_hyperplane.hpp"

namespace tesserae {

void contacts_between(const Hypersphere& sphere, const Pose& pose, const Hyperplane& plane,
                      const Pose&, double margin, PairContacts& out) {
    const double height = plane.normal.dot(pose.position) - plane.offset;
    const double separation = height - sphere.radius;
    if (!(separation <= margin)) return;
    const Vec4 point = pose.position - (sphere.radius + 0.5 * separation) * plane.normal;
    out.add(0, -plane.normal, separation, point);
}

}  // namespace tesserae
