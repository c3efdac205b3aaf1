// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"
#include "core/shape/hyperplane.hpp"

namespace tesserae {

/// Finds the vertices of a box whose separation from a plane is at most `margin` [m], reduced to
/// kManifoldPoints. In a feature bit i is set for a vertex on the positive side of the box's axis
/// i. A vertex behind the plane is moved to the free side too, however deep.
void contacts_between(const Hyperbox& box, const Pose& pose, const Hyperplane& plane,
                      const Pose& plane_pose, double margin, PairContacts& out);

}  // namespace tesserae
