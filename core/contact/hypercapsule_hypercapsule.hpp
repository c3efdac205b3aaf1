#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hypercapsule.hpp"

namespace tesserae {

/// Points whose separation is at most `margin` [m]. Capsules side by side: two, at the ends of the
/// stretch that their cores share, feature 0 towards a's -y and 1 towards a's +y, with one normal.
/// Else one, feature 2, at the closest points of the two cores.
/// Cores that meet (up to rounding) leave the normal undefined: it is orthogonal to both, and as
/// near as possible to that of a's axes x, z, w which is the most orthogonal to b's core.
void contacts_between(const Hypercapsule& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out);

}  // namespace tesserae
