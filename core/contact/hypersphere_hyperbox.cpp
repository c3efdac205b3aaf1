// SPDX-License-Identifier: Apache-2.0
#include "core/contact/hypersphere_hyperbox.hpp"

#include "core/contact/hypersphere_shape.hpp"

namespace tesserae {

void contacts_between(const Hypersphere& sphere, const Pose& pose, const Hyperbox& box,
                      const Pose& box_pose, double margin, PairContacts& out) {
    sphere_contacts(sphere, pose, box, box_pose, margin, out);
}

}  // namespace tesserae
