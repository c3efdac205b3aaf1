// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/bodies/bodies.hpp"

namespace tesserae {

/// Sum of m v over bounded bodies whose position is free [kg m/s, world], in the order of the
/// bodies.
Vec4 total_momentum(const Bodies& bodies);

/// Sum about the origin of m x ^ v over bounded bodies whose position is free and of the angular
/// momentum about the centre over those whose rotation is free [kg m^2/s, world], in the order of
/// the bodies. Neither contacts nor free motion change it, gravity does.
Bivector total_angular_momentum(const Bodies& bodies);

}  // namespace tesserae
