// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/constraints/coordinates.hpp"

namespace tesserae {

/// Its coordinates are where a point of body b is from a point of body a, along the world's axes. A
/// joint that holds all four lets both bodies turn freely about the point.
struct PointJoint {
    static constexpr int kSize = 4;  ///< number of coordinates

    Vec4 on_a = Vec4::Zero(), on_b = Vec4::Zero();  ///< from the centres, in the bodies' axes [m]
};

RowVector values_of(const PointJoint& joint, const JointedBody& a, const JointedBody& b,
                    const Rotor& near);
Coordinates coordinates_of(const PointJoint& joint, const JointedBody& a, const JointedBody& b);

}  // namespace tesserae
