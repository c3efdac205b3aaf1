#pragma once

#include <algorithm>

#include "core/dynamics/wide_kernels.hpp"

namespace tesserae {

// Coloured islands are solved in float, eight contacts at a time: velocities as changes since the
// sub-step's start, which are added to the state at the end, and targets less what the start has,
// worked out in double. So neither a body's place nor its speed costs accuracy. The points of a
// pair are one item of a colour: its bodies are read and written once for all of them.
//
// The colours are the same for any number of threads, and so are the bits.

/// Runs the parts of a stage one after the other; parallel/ has one that uses all threads.
struct OneThread {
    /// Calls work(Range) for pieces of the bodies.
    template <class Work>
    void for_bodies(Range bodies, const Work& work) const {
        work(bodies);
    }
    /// Calls work(BatchRange) for pieces of the batches.
    /// @param points   of a batch, about
    /// @return the largest result, at least 0
    template <class Work>
    double largest(BatchRange batches, std::size_t /*points*/, const Work& work) const {
        return batches.begin < batches.end ? work(batches) : 0;
    }
};

/// The records of the bodies in the range (places in ColouredIslands::bodies), unchanged yet.
void begin_changes(const WideStage& stage, Range bodies);
/// Adds the changes to the velocities.
void add_changes(const WideStage& stage, Range bodies);
/// Takes them back after the bodies have moved. Those that turn unevenly have changed their angular
/// velocity, as if by an impulse.
void take_changes_back(const WideStage& stage, Range bodies);

/// One coloured island and its colours.
class WideIsland {
  public:
    WideIsland(const Simulation& simulation, StepData& step, std::size_t island)
        : wide_(step.wide),
          number_(step.islands.coloured[island]),
          stage_{simulation, step, step.wide.mass_unit[number_]} {}

    const WideStage& stage() const { return stage_; }
    Range bodies() const { return {wide_.first_body[number_], wide_.first_body[number_ + 1]}; }

    /// Calls round(BatchRange, LaneCount) and general(BatchRange, LaneCount) for every colour in
    /// its turn.
    /// @return the largest result, at least 0
    template <class Executor, class Round, class General>
    double for_colours(const Executor& executor, bool backward, LaneCount lanes, const Round& round,
                       const General& general) const {
        const std::uint32_t first = wide_.first_colour[number_];
        const std::uint32_t count = wide_.first_colour[number_ + 1] - first;
        double most = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t colour = backward ? count - 1 - i : i;
            const ColourBatches& batches = wide_.colours[first + colour];
            const auto run_round = [&](const auto& runner, LaneCount at_once) {
                const auto work = [&](BatchRange piece) { return round(piece, at_once); };
                most = std::max(most, runner.largest(batches.round, 1, work));
            };
            const auto run_general = [&](const auto& runner, LaneCount at_once) {
                const auto work = [&](BatchRange piece) { return general(piece, at_once); };
                most = std::max(most, runner.largest(batches.general, kManifoldPoints, work));
            };
            const auto run = [&](const auto& runner, LaneCount at_once) {
                if (!backward) run_round(runner, at_once);
                run_general(runner, at_once);
                if (backward) run_round(runner, at_once);
            };
            if (colour + 1 < count)
                run(executor, lanes);
            else
                run(OneThread{}, LaneCount::kOne);  // what is left over shares bodies
        }
        return most;
    }

  private:
    const ColouredIslands& wide_;
    std::uint32_t number_;
    WideStage stage_;
};

template <class Executor>
double iterate_wide(const WideIsland& island, Pass pass, const Executor& executor,
                    LaneCount lanes) {
    const WideStage& stage = island.stage();
    double residual = 0;
    for (int i = 0; i < stage.simulation.settings.iterations; ++i) {
        const Sweep sweep = sweep_of(stage.simulation, pass, i);
        residual = island.for_colours(
            executor, sweep.backward, lanes,
            [&](BatchRange batches, LaneCount at_once) {
                return sweep_round(stage, batches, sweep, at_once);
            },
            [&](BatchRange batches, LaneCount at_once) {
                return sweep_general(stage, batches, sweep, at_once);
            });
    }
    return residual;
}

/// solve_island() of a coloured island.
template <class Executor>
void solve_wide_island(const Simulation& simulation, StepData& step, std::size_t number,
                       const Executor& executor, LaneCount lanes = LaneCount::kEight) {
    const WideIsland island(simulation, step, number);
    const WideStage& stage = island.stage();
    executor.for_bodies(island.bodies(), [&](Range bodies) { begin_changes(stage, bodies); });
    island.for_colours(
        executor, false, lanes,
        [&](BatchRange batches, LaneCount at_once) {
            start_round(stage, batches, at_once);
            return 0.0;
        },
        [&](BatchRange batches, LaneCount at_once) {
            start_general(stage, batches, at_once);
            return 0.0;
        });
    step.residual[number] = iterate_wide(island, Pass::kSolve, executor, lanes);
    executor.for_bodies(island.bodies(), [&](Range bodies) { add_changes(stage, bodies); });
}

/// relax_island() of a coloured island.
template <class Executor>
void relax_wide_island(const Simulation& simulation, StepData& step, std::size_t number,
                       const Executor& executor, LaneCount lanes = LaneCount::kEight) {
    const WideIsland island(simulation, step, number);
    const WideStage& stage = island.stage();
    if (simulation.settings.solver == Solver::kSoft) {
        executor.for_bodies(island.bodies(),
                            [&](Range bodies) { take_changes_back(stage, bodies); });
        step.residual[number] = iterate_wide(island, Pass::kRelax, executor, lanes);
        executor.for_bodies(island.bodies(), [&](Range bodies) { add_changes(stage, bodies); });
    }
    island.for_colours(
        executor, false, lanes,
        [&](BatchRange batches, LaneCount) {
            keep_round(stage, batches);
            return 0.0;
        },
        [&](BatchRange batches, LaneCount) {
            keep_general(stage, batches);
            return 0.0;
        });
}

}  // namespace tesserae
