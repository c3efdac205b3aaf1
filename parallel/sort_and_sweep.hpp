#pragma once

#include "core/dynamics/step_data.hpp"
#include "parallel/chunks.hpp"

namespace tesserae::parallel {

/// The same pairs as core's find_pairs(), found by sorting the bounds along one axis and looking,
/// from each body, only as far as its own bounds reach. The axis is the one along which centres
/// spread most; it changes the time, not the pairs. Unbounded bodies meet all others.
class SortAndSweep {
  public:
    void find_pairs(const Simulation& simulation, StepData& step);

  private:
    /// A body's bounds along the axis.
    struct Interval {
        double lower, upper;
        BodyId id;
    };

    int widest_axis(const StepData& step) const;
    void sort_intervals(const StepData& step, int axis);
    void sweep(const Simulation& simulation, const StepData& step, Range intervals,
               std::vector<BodyPair>& pairs) const;

    std::vector<BodyId> bounded_, unbounded_;  ///< ascending
    std::vector<Interval> intervals_;          ///< of the bounded ones, ascending by (lower, id)
    ChunkedList<BodyPair> lists_;
};

}  // namespace tesserae::parallel
