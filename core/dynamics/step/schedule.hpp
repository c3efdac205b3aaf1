// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/step_data.hpp"
#include "core/function_ref.hpp"
#include "core/stop.hpp"

namespace tesserae {

/// The stages of a step, as Stepper::step calls them. All but the last take place once a sub-step;
/// kStopFastBodies only after halves in which something is fast, kRegainLostTime only where it has
/// stopped something.
enum class Stage {
    kAdvanceFirstHalf,
    kFindPairs,
    kFindContacts,
    kBuildIslands,
    kSolveImpacts,
    kIntegrateVelocities,
    kSolveIslands,
    kAdvanceSecondHalf,
    kApplyCorrections,
    kStopFastBodies,
    kRegainLostTime,
    kFinishStep,
};
/// Returns the name of the stage's function, as "find_pairs".
const char* name_of(Stage stage);

/// An observer that sees every stage of a step begin and end, for traces, measurements and tests.
class StageObserver {
  public:
    virtual ~StageObserver() = default;
    /// Is called when a stage begins.
    /// @param items              number of bodies, pairs, contacts or islands that the stage works
    ///                           on
    /// @param simulation, step   as the stage finds them
    virtual void begin(Stage stage, std::size_t items, const Simulation& simulation,
                       const StepData& step) = 0;
    virtual void end(Stage stage) = 0;
};

/// The way in which the work of a step's stages is shared out. It decides nothing: every schedule
/// gives the same bits. This one does all work on the calling thread and tests every two bodies for
/// pairs.
class Schedule {
  public:
    virtual ~Schedule() = default;

    /// Sets the question that the functions below ask before each piece of work, where there are
    /// several, and on a yes throw Stopped; null: they ask none.
    void ask(const StopQuestion* stop) { stop_ = stop; }
    /// Asks it now, for work that is in no range.
    /// @throws Stopped   the step is to end
    void look_for_stop() const { tesserae::look_for_stop(stop_); }

    /// Calls work(Range) for ranges that cover 0 <= i < count once. Each range begins at a multiple
    /// of `grain` items. Items of different ranges do not depend on each other.
    virtual void for_each_range(std::size_t count, std::size_t grain,
                                FunctionRef<void(Range)> work);
    /// Returns whether test(Range) is true for any such range.
    virtual bool any_range(std::size_t count, std::size_t grain, FunctionRef<bool(Range)> test);

    /// Finds step.pairs from step.bounds: all pairs for which is_pair() is true, ascending.
    virtual void find_pairs(const Simulation& simulation, StepData& step);
    /// Finds step.pairs again from unchanged bounds, after bodies woke.
    virtual void choose_pairs(const Simulation& simulation, StepData& step);

    /// Calls solve_impact() for every island; the next two call solve_island() and
    /// apply_correction().
    virtual void solve_impacts(const Simulation& simulation, StepData& step);
    virtual void solve_islands(const Simulation& simulation, StepData& step);
    virtual void apply_corrections(const Simulation& simulation, StepData& step);

    /// Drops what is kept to make the next step faster. It changes no result.
    virtual void forget_hints() {}

  protected:
    const StopQuestion* stop() const { return stop_; }

  private:
    const StopQuestion* stop_ = nullptr;
};

}  // namespace tesserae
