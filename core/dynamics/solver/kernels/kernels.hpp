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

/// Calls work(BatchRange) for all batches in the order of a sweep: for two neighbours at once if
/// both have the same number of rows, else for one.
/// @return the largest result, at least 0
template <class Work>
double largest_of_twos(const std::vector<Batch>& all, BatchRange batches, bool backward,
                       const Work& work) {
    double largest = 0;
    auto [begin, end] = batches;
    while (begin < end) {
        const std::uint32_t two = backward ? end - 1 : begin + 1;  // the second of two
        const bool at_once = end - begin > 1 && all[two - 1].rows == all[two].rows;
        const BatchRange some =
            backward ? BatchRange{end - 1 - at_once, end} : BatchRange{begin, begin + 1 + at_once};
        largest = std::max<double>(largest, work(some));
        (backward ? end : begin) = backward ? some.begin : some.end;
    }
    return largest;
}

/// Returns a map with 0 for the entries that are negligible beside its diagonal, see kSpeck.
inline BivectorMap without_specks(const BivectorMap& map) {
    const double least = kSpeck * map.diagonal().cwiseAbs().maxCoeff();
    return (map.array().abs() < least).select(BivectorMap::Zero(), map);
}

/// What the kernels need to know of a coloured island and the pass over it.
struct ColouredStage {
    const Simulation& simulation;
    StepData& step;
    double mass_unit;  ///< [kg]
    Cause cause = Cause::kLoad;
    Parting parting = {};
    bool friction = true;  ///< false: friction is left out
    bool made = false;  ///< the rows are there from the impact before, but for what they start from
};

// The functions for round batches and for general ones do the same. Batches of one colour may be
// worked on at the same time.

/// Makes the rows of round batches and applies the impulses that they start from.
void start_round(const ColouredStage& stage, BatchRange batches, LaneCount lanes);
/// Does one sweep over round batches.
/// @return the largest velocity_left() [m/s] if it is measured, else 0
double sweep_round(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes);
/// Writes step.impulses of the batches' contacts, or step.hit after an impact.
void keep_round(const ColouredStage& stage, BatchRange batches);
/// Makes what the warm start has changed a part of the start of the rows.
void take_warm_start_round(const ColouredStage& stage, BatchRange batches);

void start_general(const ColouredStage& stage, BatchRange batches, LaneCount lanes);
double sweep_general(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes);
void keep_general(const ColouredStage& stage, BatchRange batches);
void take_warm_start_general(const ColouredStage& stage, BatchRange batches);

/// Returns the work of a batch's impulses as LoadWork::work has it [mass units m^2/s^2].
double load_work_of_round(const ColouredStage& stage, std::uint32_t batch);
double load_work_of_general(const ColouredStage& stage, std::uint32_t batch);
/// Multiplies the impulses of the batches by a part.
void leave_part_of_round(const ColouredStage& stage, BatchRange batches, float part);
void leave_part_of_general(const ColouredStage& stage, BatchRange batches, float part);

}  // namespace tesserae
