// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/algebra/bivector.hpp"

namespace tesserae::bench {

/// World angular velocity [rad/s] after a time [s] of free rotation from the identity orientation,
/// by classical Runge-Kutta on the rotation matrix Q in long double: dQ/dt = Q W with W_ij =
/// L_ij / (J_i + J_j), L the constant angular momentum seen from the body. Shares nothing with the
/// engine's rotors.
/// @param moments   second moments J in the body frame [kg m^2]
/// @param steps     20000 for 2 s at some 3 rad/s: twice as many move the result by 5e-15 of
/// |omega|
Bivector free_rotation(const Vec4& moments, const Bivector& omega, double time, int steps);

}  // namespace tesserae::bench
