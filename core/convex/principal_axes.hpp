// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/algebra/rotor.hpp"

namespace tesserae {

/// PrincipalAxes are the axes along which a matrix of second moments is diagonal.
struct PrincipalAxes {
    Vec4 moments;
    Rotor axes;      ///< rotor from the principal axes to the given axes
    bool are_given;  ///< the principal axes are the given ones, and the rotor is 1
};

/// Returns the principal axes of a matrix of second moments. Moments that agree to 1e-9 of their
/// sum are made equal. Where axes may be chosen, those nearest to the given axes are taken, in
/// their order.
PrincipalAxes principal_axes(const Mat4& moments);

}  // namespace tesserae
