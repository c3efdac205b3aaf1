#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"
#include "core/shape/hypersphere.hpp"

namespace tesserae {

/// At most one point, feature 0, reported when the separation is at most `margin` [m]. A centre
/// inside the box is pushed through the nearest of the eight cells; of several the one across the
/// lowest axis, in the middle between two opposite ones the one on the axis's positive side.
void contacts_between(const Hypersphere& sphere, const Pose& pose, const Hyperbox& box,
                      const Pose& box_pose, double margin, PairContacts& out);

}  // namespace tesserae
