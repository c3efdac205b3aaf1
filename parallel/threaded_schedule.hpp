// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/schedule.hpp"
#include "parallel/island_graph.hpp"
#include "parallel/kept_pairs.hpp"

namespace tesserae::parallel {

/// Shares the work of a step out among the threads of an arena: ranges as tasks, islands as
/// messages of a flow graph, coloured ones on all threads; pairs from a search that sorts and
/// sweeps, whose candidates are kept from step to step.
class ThreadedSchedule : public Schedule {
  public:
    /// Built in the arena of the calling thread, which its graph then uses.
    ThreadedSchedule() = default;

    /// Every message of islands is a span of the trace. Null ends that.
    void set_trace(Trace* trace) { trace_ = trace; }

    void for_each_range(std::size_t count, std::size_t grain,
                        FunctionRef<void(Range)> work) override;
    bool any_range(std::size_t count, std::size_t grain, FunctionRef<bool(Range)> test) override;
    void find_pairs(const Simulation& simulation, StepData& step) override;
    void choose_pairs(const Simulation& simulation, StepData& step) override;
    void solve_impacts(const Simulation& simulation, StepData& step) override;
    void solve_islands(const Simulation& simulation, StepData& step) override;
    void apply_corrections(const Simulation& simulation, StepData& step) override;
    void forget_hints() override { kept_pairs_.forget(); }

  private:
    Ranges ranges() const { return Ranges(stop()); }

    KeptPairs kept_pairs_;
    IslandGraph island_graph_;
    Trace* trace_ = nullptr;
};

}  // namespace tesserae::parallel
