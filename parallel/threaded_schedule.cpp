// SPDX-License-Identifier: Apache-2.0
#include "parallel/threaded_schedule.hpp"

#include "core/dynamics/solver/solver.hpp"
#include "parallel/coloured_island.hpp"

namespace tesserae::parallel {

void ThreadedSchedule::for_each_range(std::size_t count, std::size_t grain,
                                      FunctionRef<void(Range)> work) {
    ranges().for_each(count, grain, work);
}

bool ThreadedSchedule::any_range(std::size_t count, std::size_t grain,
                                 FunctionRef<bool(Range)> test) {
    return ranges().any(count, grain, test);
}

void ThreadedSchedule::find_pairs(const Simulation& simulation, StepData& step) {
    kept_pairs_.refresh(simulation, step, ranges());
}

void ThreadedSchedule::choose_pairs(const Simulation& simulation, StepData& step) {
    kept_pairs_.choose_pairs(simulation, step, ranges());
}

void ThreadedSchedule::solve_impacts(const Simulation& simulation, StepData& step) {
    island_graph_.run(simulation, step, ranges(), solve_impact, solve_coloured_impact, trace_);
}

void ThreadedSchedule::solve_islands(const Simulation& simulation, StepData& step) {
    island_graph_.run(simulation, step, ranges(), solve_island, solve_coloured_island, trace_);
}

void ThreadedSchedule::apply_corrections(const Simulation& simulation, StepData& step) {
    island_graph_.run(simulation, step, ranges(), apply_correction, apply_coloured_correction,
                      trace_);
}

}  // namespace tesserae::parallel
