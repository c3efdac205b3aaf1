// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/dynamics/step/step_data.hpp"
#include "parallel/ranges.hpp"
#include "parallel/trace.hpp"

namespace tesserae::parallel {

/// A flow graph with one node of unlimited concurrency, to which islands are sent as messages:
/// the largest first, so that the last one to end is short, and small ones several to a message,
/// so that a message is worth its cost. Islands share nothing that changes, so that any order of
/// solving gives the same bits.
class IslandGraph {
  public:
    /// Built in the arena of the calling thread, which its work then uses.
    IslandGraph();
    ~IslandGraph();
    IslandGraph(const IslandGraph&) = delete;
    IslandGraph& operator=(const IslandGraph&) = delete;

    /// Of one island: core's solve_island() or apply_correction(), and their like for coloured
    /// ones.
    using Work = void(const Simulation&, StepData&, std::size_t island);
    using ColouredWork = void(const Simulation&, StepData&, std::size_t island, const Ranges&);
    /// Does the work for all islands of the step; every message is a span of the trace.
    /// @throws Stopped   the work is to end
    void run(const Simulation& simulation, StepData& step, const Ranges& ranges, Work& of_plain,
             ColouredWork& of_coloured, Trace* trace = nullptr);

  private:
    struct Graph;
    std::unique_ptr<Graph> graph_;
};

}  // namespace tesserae::parallel
