// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "core/dynamics/constraints/contact_targets.hpp"
#include "core/dynamics/solver/sweep.hpp"

namespace tesserae {

/// The number of lanes that are worked on at a time. The results have the same bits. Batches whose
/// pairs share movable bodies need kOne, which goes through the lanes in order. kSixteen sweeps two
/// batches at once, where the CPU has it: a sweep waits for one operation after the other, so that
/// two batches take little longer than one.
enum class LaneCount { kOne, kEight, kSixteen };
/// Returns the largest number of lanes that this CPU has.
LaneCount most_lanes();

/// Calls work(BatchRange) for all batches that have lanes of `some` islands, in the order of a
/// sweep: for two neighbours at once if both have the same number of rows, else for one.
/// @return the largest result, at least 0
template <class Work>
double largest_of_twos(const std::vector<Batch>& all, BatchRange batches, bool backward,
                       Members some, const Work& work) {
    double largest = 0;
    auto [begin, end] = batches;
    const auto takes_part = [&](std::uint32_t i) { return (all[i].members & some).any(); };
    while (begin < end) {
        const std::uint32_t one = backward ? end - 1 : begin;
        if (!takes_part(one)) {
            (backward ? end : begin) = backward ? end - 1 : begin + 1;
            continue;
        }
        const std::uint32_t two = backward ? end - 1 : begin + 1;  // the second of two
        const bool at_once = end - begin > 1 && all[two - 1].rows == all[two].rows &&
                             takes_part(two - 1) && takes_part(two);
        const BatchRange pair =
            backward ? BatchRange{end - 1 - at_once, end} : BatchRange{begin, begin + 1 + at_once};
        largest = std::max<double>(largest, work(pair));
        (backward ? end : begin) = backward ? pair.begin : pair.end;
    }
    return largest;
}

/// Calls work(BatchRange) for all batches that have lanes of `some` islands, in the order of a
/// sweep: for two at once where there are sixteen lanes, else for one.
/// @return the largest result, at least 0
template <class Work>
double sweep_batches(const std::vector<Batch>& all, BatchRange batches, Sweep sweep,
                     LaneCount lanes, Members some, const Work& work) {
    if (lanes == LaneCount::kSixteen)
        return largest_of_twos(all, batches, sweep.backward, some, work);
    double largest = 0;
    for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
        const std::uint32_t batch = sweep.backward ? batches.begin + (batches.end - 1 - i) : i;
        if ((all[batch].members & some).any())
            largest = std::max<double>(largest, work({batch, batch + 1}));
    }
    return largest;
}

/// Returns the number of each lane's island.
inline Eight of_lanes(const Batch& batch, const PerMember<float>& numbers) {
    Eight lanes;
    if (batch.members == Members::only(0))
        lanes.lane.fill(numbers[0]);
    else
        for (std::size_t k = 0; k < kLanes; ++k) lanes.lane[k] = numbers[batch.member[k]];
    return lanes;
}
/// Returns 1 for the lanes of `some` islands, and 0 for the others.
inline Eight lanes_of(const Batch& batch, Members some) {
    Eight lanes;
    if (batch.members == Members::only(0))
        lanes.lane.fill(some.has(0) ? 1 : 0);
    else
        for (std::size_t k = 0; k < kLanes; ++k) lanes.lane[k] = some.has(batch.member[k]) ? 1 : 0;
    return lanes;
}

/// Returns a map with 0 for the entries that are negligible beside its diagonal, see kSpeck.
inline BivectorMap without_specks(const BivectorMap& map) {
    const double least = kSpeck * map.diagonal().cwiseAbs().maxCoeff();
    return (map.array().abs() < least).select(BivectorMap::Zero(), map);
}

/// What the kernels need to know of a group of coloured islands and the pass over it.
struct ColouredStage {
    const Simulation& simulation;
    StepData& step;
    std::uint32_t first_member;   ///< place of the first island among the coloured ones
    bool shares_batches = false;  ///< see ColouredIslands::shares_batches
    Cause cause = Cause::kLoad;
    PerMember<Parting> parting = {};
    bool made = false;  ///< the rows are there from the impact before, but for what they start from

    /// Returns the mass unit of an island [kg].
    double mass_unit(std::size_t member) const {
        return step.coloured.mass_unit[first_member + member];
    }
};

// The functions for round batches and for general ones do the same. Batches of one colour may be
// worked on at the same time. They leave the lanes of islands that are not among `some` as they
// are.

/// Makes the rows of round batches and applies the impulses that they start from.
void start_round(const ColouredStage& stage, BatchRange batches, LaneCount lanes, Members some);
/// Does one sweep over round batches. If it is measured, the lanes' velocity_left() is in
/// ColouredIslands::round_left.
/// @return the largest velocity_left() [m/s] if it is measured, else 0
double sweep_round(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes,
                   Members some);
/// Writes step.impulses of the batches' contacts, or step.hit after an impact.
void keep_round(const ColouredStage& stage, BatchRange batches, Members some);
/// Makes what the warm start has changed a part of the start of the rows.
void take_warm_start_round(const ColouredStage& stage, BatchRange batches, Members some);

void start_general(const ColouredStage& stage, BatchRange batches, LaneCount lanes, Members some);
double sweep_general(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes,
                     Members some);
void keep_general(const ColouredStage& stage, BatchRange batches, Members some);
void take_warm_start_general(const ColouredStage& stage, BatchRange batches, Members some);

/// Returns the work of a batch's impulses as LoadWork::work has it, of each lane
/// [mass units m^2/s^2].
Eight load_work_of_round(const ColouredStage& stage, std::uint32_t batch);
Eight load_work_of_general(const ColouredStage& stage, std::uint32_t batch);
/// Multiplies the impulses of the batches by each island's part.
void leave_part_of_round(const ColouredStage& stage, BatchRange batches,
                         const PerMember<float>& parts);
void leave_part_of_general(const ColouredStage& stage, BatchRange batches,
                           const PerMember<float>& parts);

}  // namespace tesserae
