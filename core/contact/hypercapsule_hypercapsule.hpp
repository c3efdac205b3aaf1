#pragma once

#include "core/contact/contact.hpp"
#include "core/shape/hypercapsule.hpp"

namespace tesserae {

/// Cores count as side by side when they part by less than this share of the smaller radius over
/// the stretch that they share, usual 0.05. The ends of that stretch then lie on the surfaces, seen
/// from the middle between them, to half its square. More, and they do not to a quarter of what the
/// solver leaves alone; less, and logs that lie on each other a hair aslant turn about one end and
/// the other until they have gone into each other (at 3e-5 a pile of twelve between walls).
constexpr double kSideBySide = 0.05;

/// Points whose separation is at most `margin` [m]. Capsules side by side: two, at the ends of the
/// stretch that their cores share, feature 0 towards a's -y and 1 towards a's +y, with one normal.
/// Else one, feature 2, at the closest points of the two cores.
/// Cores that meet (up to rounding) leave the normal undefined: it is orthogonal to both, and as
/// near as possible to that of a's axes x, z, w which is the most orthogonal to b's core.
void contacts_between(const Hypercapsule& a, const Pose& pose_a, const Hypercapsule& b,
                      const Pose& pose_b, double margin, PairContacts& out);

}  // namespace tesserae
