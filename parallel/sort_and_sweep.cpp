#include "parallel/sort_and_sweep.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <tuple>

#include "core/dynamics/pairs.hpp"

namespace tesserae::parallel {
namespace {

/// Intervals that one task sweeps: some 10 us of work.
constexpr std::size_t kGrain = 128;

BodyPair ordered(BodyId i, BodyId j) { return {std::min(i, j), std::max(i, j)}; }

}  // namespace

void SortAndSweep::find_pairs(const Simulation& simulation, StepData& step) {
    bounded_.clear();
    unbounded_.clear();
    for (BodyId id = 0; id < simulation.bodies.size(); ++id)
        (simulation.type_of(id).bounded ? bounded_ : unbounded_).push_back(id);

    sort_intervals(step, widest_axis(step));
    lists_.collect(
        intervals_.size(), kGrain,
        [&](Range range, std::vector<BodyPair>& pairs) { sweep(simulation, step, range, pairs); },
        step.pairs);
    tbb::parallel_sort(step.pairs);
}

int SortAndSweep::widest_axis(const StepData& step) const {
    // In the bodies' order, so that rounding does not depend on threads.
    Vec4 sum = Vec4::Zero(), squares = Vec4::Zero();
    for (BodyId id : bounded_) {
        sum += step.position[id];
        squares += step.position[id].cwiseAbs2();
    }
    const Vec4 spread =
        squares - sum.cwiseAbs2() / std::max(1.0, static_cast<double>(bounded_.size()));
    int axis = 0;
    for (int i = 1; i < 4; ++i)
        if (spread[i] > spread[axis]) axis = i;
    return axis;
}

void SortAndSweep::sort_intervals(const StepData& step, int axis) {
    intervals_.clear();
    for (BodyId id : bounded_)
        intervals_.push_back({step.bounds[id].lower[axis], step.bounds[id].upper[axis], id});
    tbb::parallel_sort(intervals_, [](const Interval& i, const Interval& j) {
        return std::tie(i.lower, i.id) < std::tie(j.lower, j.id);
    });
}

void SortAndSweep::sweep(const Simulation& simulation, const StepData& step, Range intervals,
                         std::vector<BodyPair>& pairs) const {
    for (std::size_t i = intervals.begin; i < intervals.end; ++i) {
        const Interval& first = intervals_[i];
        const auto add = [&](BodyId other) {
            const BodyPair pair = ordered(first.id, other);
            if (is_pair(simulation, step, pair.a, pair.b)) pairs.push_back(pair);
        };
        for (std::size_t j = i + 1; j < intervals_.size(); ++j) {
            if (intervals_[j].lower > first.upper) break;
            add(intervals_[j].id);
        }
        for (BodyId other : unbounded_) add(other);
    }
}

}  // namespace tesserae::parallel
