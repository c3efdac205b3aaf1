// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/solver.hpp"

#include "core/dynamics/solver/coloured_rows.hpp"
#include "core/dynamics/solver/plain_rows.hpp"

namespace tesserae {

void solve_impact(const Simulation& simulation, StepData& step, std::size_t island) {
    if (step.islands.is_coloured(island))
        return solve_coloured_impact(simulation, step, island, OneThread{});
    PlainRows rows(simulation, step, island);
    solve_impact(rows);
}

void solve_island(const Simulation& simulation, StepData& step, std::size_t island) {
    if (step.islands.is_coloured(island))
        return solve_coloured_island(simulation, step, island, OneThread{});
    PlainRows rows(simulation, step, island);
    solve_load(rows);
}

void apply_correction(const Simulation& simulation, StepData& step, std::size_t island) {
    if (step.islands.is_coloured(island))
        return apply_coloured_correction(simulation, step, island, OneThread{});
    PlainRows rows(simulation, step, island);
    apply_correction(rows);
}

}  // namespace tesserae
