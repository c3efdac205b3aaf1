// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hypercapsule.hpp"
#include "core/shape/hypersphere.hpp"

namespace tesserae {

/// Finds at most one point, feature 0, if the separation is at most `margin` [m]. A centre on the
/// capsule's core is moved out along the capsule's x axis.
void contacts_between(const Hypersphere& sphere, const Pose& pose, const Hypercapsule& capsule,
                      const Pose& capsule_pose, double margin, PairContacts& out);

}  // namespace tesserae
