#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hypercapsule.hpp"
#include "core/shape/hyperplane.hpp"

namespace tesserae {

/// A point for each end of the core, feature 0 towards the capsule's -y and 1 towards +y, where its
/// separation is at most `margin` [m]; for height 0 feature 0 only. Each is a contact of the ball
/// about that end. An end behind the plane is pushed to the free side too, however deep.
void contacts_between(const Hypercapsule& capsule, const Pose& pose, const Hyperplane& plane,
                      const Pose& plane_pose, double margin, PairContacts& out);

}  // namespace tesserae
