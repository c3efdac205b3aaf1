// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hypersphere.hpp"

namespace tesserae {

/// Centres closer than this [m] count as one point: the square of a smaller distance loses digits.
constexpr double kCoincident = 1e-140;

/// Finds at most one point, feature 0, if the separation is at most `margin` [m]. If the centres
/// coincide, the normal is undefined: +x is taken.
void contacts_between(const Hypersphere& a, const Pose& pose_a, const Hypersphere& b,
                      const Pose& pose_b, double margin, PairContacts& out);

}  // namespace tesserae
