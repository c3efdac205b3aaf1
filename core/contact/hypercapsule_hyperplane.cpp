// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hypercapsule_hyperplane.hpp"

#include "core/contact/capsule_core.hpp"

namespace tesserae {

void contacts_between(const Hypercapsule& capsule, const Pose& pose, const Hyperplane& plane,
                      const Pose&, double margin, PairContacts& out) {
    const double height = plane.normal.dot(pose.position) - plane.offset - capsule.radius;
    if (!(height - 0.5 * capsule.height <= margin)) return;
    const CapsuleCore core = core_of(capsule, pose);
    const double rise = plane.normal.dot(core.axis);
    const std::uint32_t ends = core.half > 0 ? 2 : 1;
    for (std::uint32_t end = 0; end < ends; ++end) {
        const double t = end == 0 ? -core.half : core.half;
        const double separation = height + t * rise;
        if (!(separation <= margin)) continue;
        const Vec4 point = core.at(t) - (capsule.radius + 0.5 * separation) * plane.normal;
        out.add(end, -plane.normal, separation, point);
    }
}

}  // namespace tesserae
