// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/constraints/coordinates.hpp"

namespace tesserae {

/// A joint between a frame of axes of body a and one of body b. Coordinates 0 to 3 are where the
/// origin of b's frame is, along the axes of a's. Coordinates 4 to 9 are the angles of the rotation
/// that takes a's axes to b's: the components of its logarithm, in the order of Bivector. A hinge
/// holds all but one angle, a slider all but one distance, a weld all ten.
struct FrameJoint {
    static constexpr int kSize = kMostRows;  ///< number of coordinates

    Vec4 on_a = Vec4::Zero(), on_b = Vec4::Zero();  ///< origins, in the bodies' axes [m]
    Rotor axes_a, axes_b;                           ///< from the frames' axes to the bodies'
};

/// @param near   the rotation, or its negative, of a place nearby: of the two logarithms the one is
///               taken that lies on its side
RowVector values_of(const FrameJoint& joint, const JointedBody& a, const JointedBody& b,
                    const Rotor& near);
Coordinates coordinates_of(const FrameJoint& joint, const JointedBody& a, const JointedBody& b);

}  // namespace tesserae
