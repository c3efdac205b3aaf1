// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "bench/experiments/experiment.hpp"

namespace tesserae::bench {

/// What an experiment depends on, so that nothing is run that could not change its result.
enum class Kind {
    kFlight,    ///< steps
    kRotation,  ///< integrator, steps
    kContact,   ///< all of the solver's knobs
    kCrowd,     ///< the same, fewer of them: seconds each
};

struct Listed {
    Experiment (*make)(const Knobs&);
    Kind kind;
};

/// In the order of the results.
std::vector<Listed> all_experiments();

/// The configurations in which experiments of a kind are measured.
std::vector<Knobs> knobs_of(Kind kind);

const char* name_of(RotationIntegrator integrator);

}  // namespace tesserae::bench
