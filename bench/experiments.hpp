#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/dynamics/world.hpp"

namespace tesserae::bench {

/// A difference from an exact result.
struct Error {
    std::string quantity, unit;
    double value;  ///< >= 0
};

/// A motion whose exact result is known.
struct Experiment {
    std::string name;
    Bodies bodies;
    PhysicsSettings settings;  ///< with duration, steps_per_second and iterations
    /// Makes the steps of a new world and compares.
    std::function<std::vector<Error>(World&)> errors;
};

/// Every motion of the list in experiments.cpp at one number of steps a second.
std::vector<Experiment> experiments(int steps_per_second);

/// A column of ten equal spheres at rest, whose lowest contact carries all: the one motion here
/// that the iterations of the solver change.
Experiment column_of_spheres(int steps_per_second, int iterations);

}  // namespace tesserae::bench
