// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hypercapsule.hpp"

namespace tesserae {

/// Cores count as side by side if, over the stretch that they share, they part by less than this
/// share of the smaller radius, usual 0.05. Seen from the middle, the ends of that stretch then lie
/// on the surfaces to half its square. More, and that error exceeds a quarter of the slop; less,
/// and logs that lie on each other slightly tilted turn about one end and then the other, and sink
/// into each other.
constexpr double kSideBySide = 0.05;

/// Finds the points of two capsules whose separation is at most `margin` [m]. Capsules side by side
/// have two, with one normal, at the ends of the stretch that their cores share: feature 0 towards
/// a's -y and 1 towards a's +y. Others have one, feature 2, at the closest points of the cores.
/// Cores that meet (up to rounding) leave the normal undefined. It is then orthogonal to both, and
/// as near as possible to the one of a's axes x, z, w that is most orthogonal to b's core.
void contacts_between(const Hypercapsule& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out);

}  // namespace tesserae
