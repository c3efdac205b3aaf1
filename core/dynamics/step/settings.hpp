// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "core/algebra/vector.hpp"

namespace tesserae {

/// How a body turns freely. Both ways keep its angular momentum.
enum class RotationIntegrator {
    kEuler,     ///< with the angular velocity of the step's start
    kMidpoint,  ///< with that of the step's middle, implicitly: keeps the energy too
};

/// The settings of a scene's [physics] table.
struct PhysicsSettings {
    Vec4 gravity = {0, -10, 0, 0};  ///< [m/s^2]
    double duration = 1;            ///< [s]
    double steps_per_second = 240;  ///< [1/s]
    int substeps = 1;  ///< equal parts of a step: pairs are found once, contacts in each
    /// The most sweeps of any solve of an island: of an impact, a load or a position correction.
    /// Large islands take a part of them, see kManySweeps.
    int iterations = 100;
    double tolerance = 1e-6;  ///< residual [m/s] at which sweeps end; 0: every solve takes all
    RotationIntegrator integrator = RotationIntegrator::kMidpoint;
    bool sleeping = false;  ///< islands at rest are left out until something touches them
    std::uint64_t seed = 1;
};

}  // namespace tesserae
