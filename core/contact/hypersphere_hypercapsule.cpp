// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hypersphere_hypercapsule.hpp"

#include "core/contact/hypersphere_shape.hpp"

namespace tesserae {

void contacts_between(const Hypersphere& sphere, const Pose& pose, const Hypercapsule& capsule,
                      const Pose& capsule_pose, double margin, PairContacts& out) {
    sphere_contacts(sphere, pose, capsule, capsule_pose, margin, out);
}

}  // namespace tesserae
