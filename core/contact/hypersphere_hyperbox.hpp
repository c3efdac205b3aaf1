// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hyperbox.hpp"
#include "core/shape/hypersphere.hpp"

namespace tesserae {

/// Finds at most one point, feature 0, if the separation is at most `margin` [m]. A centre inside
/// the box is moved out through the nearest of the eight cells. Among several it is the one across
/// the lowest axis; in the middle between two opposite cells it is the one on the positive side.
void contacts_between(const Hypersphere& sphere, const Pose& pose, const Hyperbox& box,
                      const Pose& box_pose, double margin, PairContacts& out);

}  // namespace tesserae
