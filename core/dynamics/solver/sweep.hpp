#pragma once

#include "core/dynamics/state/step_data.hpp"

namespace tesserae {

enum class Pass { kSolve, kRelax };

/// One iteration of a pass. Every other one goes through the island backward: a load at one end of
/// it then reaches the other in one iteration (a tower of ten leans 10 times less). The last one of
/// kSolve goes forward and that of kRelax backward, which is best for towers listed from the
/// ground.
struct Sweep {
    Pass pass;
    bool backward, last;
};
inline Sweep sweep_of(const Simulation& simulation, Pass pass, int iteration) {
    const int left = simulation.settings.iterations - 1 - iteration;
    return {pass, (left % 2 == 1) == (pass == Pass::kSolve), left == 0};
}

}  // namespace tesserae
