#pragma once

#include "core/algebra/rotor.hpp"

namespace tesserae {

/// The axes along which a matrix of second moments is diagonal.
struct PrincipalAxes {
    Vec4 moments;
    Rotor axes;      ///< takes them to the given axes
    bool are_given;  ///< they are the given axes, and the rotor is 1
};

/// Moments that agree to 1e-9 are made equal: among axes that may be chosen, the nearest to the
/// given ones are, in their order.
PrincipalAxes principal_axes(const Mat4& moments);

}  // namespace tesserae
