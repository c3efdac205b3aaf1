#pragma once

#include <limits>

#include "core/contact/contact.hpp"
#include "core/shape/hypercapsule.hpp"

namespace tesserae {

/// The segment that a capsule is about: centre + t axis, |t| <= half.
struct CapsuleCore {
    Vec4 centre;  ///< [m]
    Vec4 axis;    ///< unit
    double half;  ///< [m], >= 0

    Vec4 at(double t) const { return centre + t * axis; }
};

/// In the world.
inline CapsuleCore core_of(const Hypercapsule& capsule, const Pose& pose) {
    return {pose.position, y_axis_of(pose.rotor), 0.5 * capsule.height};
}

/// A distance of two cores below this part of the lengths that it was computed from is rounding
/// and has no direction: the cores meet.
constexpr double kCoreRounding = 16 * std::numeric_limits<double>::epsilon();

/// Two contact points closer than this part of the radius count as one.
constexpr double kShortStretch = 1e-4;

}  // namespace tesserae
