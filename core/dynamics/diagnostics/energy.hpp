// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/bodies/bodies.hpp"

namespace tesserae {

/// Sum of m v^2 / 2 over bounded bodies whose position is free and of omega . L / 2 over those
/// whose rotation is free [J], in the order of the bodies.
double kinetic_energy(const Bodies& bodies);

/// Sum of -m g . x times the gravity_scale over bounded bodies whose position is free [J], in the
/// order of the bodies.
double potential_energy(const Bodies& bodies, const Vec4& gravity);

}  // namespace tesserae
