// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hyperplane.hpp"
#include "core/shape/hypersphere.hpp"

namespace tesserae {

/// Finds at most one point, feature 0, if the separation is at most `margin` [m]. A centre behind
/// the plane is moved to the free side too, however deep.
void contacts_between(const Hypersphere& sphere, const Pose& pose, const Hyperplane& plane,
                      const Pose& plane_pose, double margin, PairContacts& out);

}  // namespace tesserae
