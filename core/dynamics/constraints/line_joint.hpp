// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/constraints/coordinates.hpp"

namespace tesserae {

/// Its one coordinate is the distance of a point of body b from a point of body a, less a length.
/// Held, it is a rod without mass; with 0 as its upper limit a rope; driven a spring.
struct LineJoint {
    static constexpr int kSize = 1;  ///< number of coordinates

    Vec4 on_a = Vec4::Zero(), on_b = Vec4::Zero();  ///< from the centres, in the bodies' axes [m]
    double length = 0;                              ///< [m]
};

RowVector values_of(const LineJoint& joint, const JointedBody& a, const JointedBody& b,
                    const Rotor& near);
Coordinates coordinates_of(const LineJoint& joint, const JointedBody& a, const JointedBody& b);

}  // namespace tesserae
