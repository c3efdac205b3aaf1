// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "core/contact/contact.hpp"
#include "core/shape/hypercapsule.hpp"

namespace tesserae {

/// A CapsuleCore is the segment in the middle of a capsule: centre + t axis, |t| <= half.
struct CapsuleCore {
    Vec4 centre;  ///< [m]
    Vec4 axis;    ///< unit
    double half;  ///< [m], >= 0

    Vec4 at(double t) const { return centre + t * axis; }
};

/// Returns the core of a capsule in the world frame.
inline CapsuleCore core_of(const Hypercapsule& capsule, const Pose& pose) {
    return {pose.position, y_axis_of(pose.rotor), 0.5 * capsule.height};
}

/// Two cores meet if their distance is below this part of the lengths that it was computed from.
/// Such a distance is rounding and has no direction.
constexpr double kCoreRounding = 16 * std::numeric_limits<double>::epsilon();

/// Two contact points closer than this part of the radius count as one, usual 1e-4.
constexpr double kShortStretch = 1e-4;

}  // namespace tesserae
