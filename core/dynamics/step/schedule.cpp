// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/step/schedule.hpp"

#include <algorithm>

#include "core/dynamics/contacts/pairs.hpp"
#include "core/dynamics/solver/solver.hpp"

namespace tesserae {

const char* name_of(Stage stage) {
    constexpr const char* kNames[] = {
        "advance_first_half", "find_pairs",           "find_contacts",    "build_islands",
        "solve_impacts",      "integrate_velocities", "solve_islands",    "advance_second_half",
        "apply_corrections",  "stop_fast_bodies",     "regain_lost_time", "finish_step"};
    return kNames[static_cast<std::size_t>(stage)];
}

void Schedule::for_each_range(std::size_t count, std::size_t grain, FunctionRef<void(Range)> work) {
    if (stop_ == nullptr || count <= grain) return work({0, count});
    for (std::size_t begin = 0; begin < count; begin += grain) {
        look_for_stop();
        work({begin, std::min(count, begin + grain)});
    }
}

bool Schedule::any_range(std::size_t count, std::size_t grain, FunctionRef<bool(Range)> test) {
    bool any = false;
    for_each_range(count, grain, [&](Range range) { any = any || test(range); });
    return any;
}

void Schedule::find_pairs(const Simulation& simulation, StepData& step) {
    test_all_pairs(simulation, step);
}

void Schedule::choose_pairs(const Simulation& simulation, StepData& step) {
    test_all_pairs(simulation, step);
}

void Schedule::solve_impacts(const Simulation& simulation, StepData& step) {
    for (std::size_t island = 0; island < step.islands.size(); ++island) {
        if (island > 0) look_for_stop();
        solve_impact(simulation, step, island);
    }
}

void Schedule::solve_islands(const Simulation& simulation, StepData& step) {
    for (std::size_t island = 0; island < step.islands.size(); ++island) {
        if (island > 0) look_for_stop();
        solve_island(simulation, step, island);
    }
}

void Schedule::apply_corrections(const Simulation& simulation, StepData& step) {
    for (std::size_t island = 0; island < step.islands.size(); ++island) {
        if (island > 0) look_for_stop();
        apply_correction(simulation, step, island);
    }
}

}  // namespace tesserae
