#pragma once

#include "core/dynamics/step_data.hpp"

namespace tesserae {

/// step.impulses of the contacts in the range: what the last sub-step left for the same
/// (a, b, feature), else zero.
void recall_impulses(const Simulation& simulation, StepData& step, Range contacts);

/// Solves the contacts of one island by sequential impulses, accumulated and clamped, warm
/// started, in the order that Islands gives: changes the velocities of its movable bodies. Touches
/// nothing of another island. Source: E. Catto, "Iterative dynamics with temporal coherence", 2005;
/// friction is a block of three directions instead of separate ones.
void solve_island(const Simulation& simulation, StepData& step, std::size_t island);

/// Once the island's bodies have moved by the velocities that solve_island() gave them: with
/// Solver::kSoft takes back the part of the velocities that removed overlap (M. Macklin et al.,
/// "Small steps in physics simulation", 2019; E. Catto, "Solver2D", 2024). Leaves the island's
/// impulses in step.impulses.
void relax_island(const Simulation& simulation, StepData& step, std::size_t island);

// What solve_island() and relax_island() are made of. Range: places in islands.contacts and
// step.rows. Places that share no movable body may be worked on at the same time.

void make_rows(const Simulation& simulation, StepData& step, Range places);
/// Needs the rows of all contacts of the island.
void warm_start(const Simulation& simulation, StepData& step, Range places);

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
/// @return the largest change of a normal velocity [m/s] if it is the last sweep, else 0
double sweep_contacts(const Simulation& simulation, StepData& step, Range places, Sweep sweep);

/// step.impulses of the contacts at these places, from their rows.
void keep_impulses(StepData& step, Range places);

}  // namespace tesserae
