// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hypercapsule.hpp"
#include "core/shape/hyperplane.hpp"

namespace tesserae {

/// Finds the ends of a capsule's core whose separation from a plane is at most `margin` [m]:
/// feature 0 towards the capsule's -y and 1 towards +y; for height 0 only feature 0. Each is a
/// contact of the ball about that end. An end behind the plane is moved to the free side too,
/// however deep.
void contacts_between(const Hypercapsule& capsule, const Pose& pose, const Hyperplane& plane,
                      const Pose& plane_pose, double margin, PairContacts& out);

}  // namespace tesserae
