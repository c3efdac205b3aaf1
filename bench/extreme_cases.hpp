// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/dynamics/stepper.hpp"

// Stiff and extreme scenes: what a user may ask for and an engine may fail at.
namespace tesserae::bench {

struct Measurement {
    std::string quantity, unit;
    double value;
};

/// One scene and what is measured of it under given settings (solver, iterations, sub-steps).
struct ExtremeCase {
    std::string name;
    /// @throws LeftFiniteRange
    std::function<std::vector<Measurement>(PhysicsSettings)> measure;
};

/// Minutes in all. `with_long` adds the one that takes the longest: 10^4 spheres at rest for 60 s.
std::vector<ExtremeCase> extreme_cases(bool with_long);
/// Scenes with joints, and a card house and an arch, which others publish as hard.
std::vector<ExtremeCase> extreme_joints();

}  // namespace tesserae::bench
