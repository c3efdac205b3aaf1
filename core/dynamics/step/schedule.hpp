#pragma once

#include "core/dynamics/step/step_data.hpp"
#include "core/function_ref.hpp"

namespace tesserae {

/// The stages of a step in their order, as World::step calls them; all but the last once a
/// sub-step, and kStopFastBodies only after halves in which something is fast.
enum class Stage {
    kAdvanceFirstHalf,
    kFindPairs,
    kFindContacts,
    kBuildIslands,
    kSolveImpacts,
    kIntegrateVelocities,
    kSolveIslands,
    kAdvanceSecondHalf,
    kDropCorrections,
    kStopFastBodies,
    kFinishStep,
};
/// The name of the stage's function: "find_pairs".
const char* name_of(Stage stage);

/// Sees every stage of a step begin and end: for traces, measurements and tests.
class StageObserver {
  public:
    virtual ~StageObserver() = default;
    /// @param items        bodies, pairs, contacts or islands: what the stage works on
    /// @param simulation   and `step`: as the stage finds them
    virtual void begin(Stage stage, std::size_t items, const Simulation& simulation,
                       const StepData& step) = 0;
    virtual void end(Stage stage) = 0;
};

/// How the work of a step's stages is shared out. It decides nothing: every schedule gives the same
/// bits. This one does all of it on the calling thread and tests every two bodies for pairs.
class Schedule {
  public:
    virtual ~Schedule() = default;

    /// Calls work(Range) for ranges that cover 0 <= i < count once. Each begins at a multiple of
    /// `grain`, in items; those of one range do not depend on those of another.
    virtual void for_each_range(std::size_t count, std::size_t grain,
                                FunctionRef<void(Range)> work);
    /// Whether test(Range) is true of any such range.
    virtual bool any_range(std::size_t count, std::size_t grain, FunctionRef<bool(Range)> test);

    /// step.pairs from step.bounds: those of all bodies that is_pair() says yes to, ascending.
    virtual void find_pairs(const Simulation& simulation, StepData& step);
    /// The same from bounds that have not changed, after bodies woke.
    virtual void choose_pairs(const Simulation& simulation, StepData& step);

    /// solve_impact() of every island, solve_island() and drop_correction().
    virtual void solve_impacts(const Simulation& simulation, StepData& step);
    virtual void solve_islands(const Simulation& simulation, StepData& step);
    virtual void drop_corrections(const Simulation& simulation, StepData& step);
};

}  // namespace tesserae
