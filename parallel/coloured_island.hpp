// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/solver/solver.hpp"
#include "parallel/ranges.hpp"

namespace tesserae::parallel {

/// core's solve_impact(), solve_island() and apply_correction() of a coloured island on all
/// threads: colour by colour, the contacts of a colour at once, with the same bits. What is left
/// over is solved by one thread.
/// @throws Stopped   the ranges' question was true; the island is then half solved
void solve_coloured_impact(const Simulation& simulation, StepData& step, std::size_t island,
                           const Ranges& ranges);
void solve_coloured_island(const Simulation& simulation, StepData& step, std::size_t island,
                           const Ranges& ranges);
void apply_coloured_correction(const Simulation& simulation, StepData& step, std::size_t island,
                               const Ranges& ranges);

}  // namespace tesserae::parallel
