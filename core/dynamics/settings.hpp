#pragma once

#include <cstdint>

#include "core/algebra/vector.hpp"

namespace tesserae {

/// How orientation is advanced over a step.
enum class Integrator {
    kEuler,     ///< angular velocity of the step's start
    kMidpoint,  ///< angular velocity at the middle, from the angular momentum held constant
};

/// The [physics] table.
struct PhysicsSettings {
    Vec4 gravity = {0, -10, 0, 0};  ///< [m/s^2]
    double duration = 1;            ///< [s]
    double steps_per_second = 240;  ///< [1/s]
    int iterations = 10;            ///< of the contact solver, a step
    Integrator integrator = Integrator::kEuler;
    std::uint64_t seed = 1;
};

}  // namespace tesserae
