#pragma once

#include <cstdint>

#include "core/algebra/vector.hpp"

namespace tesserae {

/// How a body turns freely; its angular momentum stays in both.
enum class RotationIntegrator {
    kEuler,     ///< with the angular velocity of the step's start
    kMidpoint,  ///< with that of the middle, implicitly: keeps the energy too
};

/// The [physics] table.
struct PhysicsSettings {
    Vec4 gravity = {0, -10, 0, 0};  ///< [m/s^2]
    double duration = 1;            ///< [s]
    double steps_per_second = 240;  ///< [1/s]
    int substeps = 1;  ///< of equal length, a step: pairs are looked for once, contacts in each
    /// Sweeps of the contact solver over an island, a sub-step, at most; see effort_of_load() for
    /// what may take more.
    int iterations = 10;
    double tolerance = 1e-6;  ///< residual [m/s] below which its sweeps end; 0: all of them
    RotationIntegrator integrator = RotationIntegrator::kMidpoint;
    bool sleeping = false;  ///< islands at rest are left out until something touches them
    std::uint64_t seed = 1;
};

}  // namespace tesserae
