#pragma once

#include <algorithm>
#include <vector>

#include "core/dynamics/constraints/contact_targets.hpp"
#include "core/dynamics/solver/sweep.hpp"

namespace tesserae {

/// How many lanes are worked on at a time: the results are the same bits. Batches whose pairs share
/// movable bodies need kOne, which goes through the lanes in order. kSixteen, where the CPU has it,
/// sweeps two batches at once: a sweep waits for one operation after the other, not for their
/// number.
enum class LaneCount { kOne, kEight, kSixteen };
/// The most that this CPU has.
LaneCount most_lanes();

/// Calls work(BatchRange) for all batches in the order of a sweep: for two neighbours that have as
/// many rows at once, else for one.
/// @return the largest that it returns, at least 0
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

/// Without the entries that are specks beside the diagonal, see kSpeck.
inline BivectorMap without_specks(const BivectorMap& map) {
    const double least = kSpeck * map.diagonal().cwiseAbs().maxCoeff();
    return (map.array().abs() < least).select(BivectorMap::Zero(), map);
}

/// What a coloured island's batches are made into and from.
struct ColouredStage {
    const Simulation& simulation;
    StepData& step;
    double mass_unit;  ///< [kg]
    Cause cause = Cause::kLoad;
    Parting parting = {};
    bool friction = true;  ///< false: without
    bool made = false;  ///< the rows are those of the impact before, but for what they start from
};

// Of round and of general batches: makes their rows and applies the impulses that they start from;
// one iteration; step.impulses of their contacts, or of an impact step.hit. Batches of one colour
// may be worked on at the same time.

void start_round(const ColouredStage& stage, BatchRange batches, LaneCount lanes);
/// @return the largest velocity_left() [m/s] if it is measured, else 0
double sweep_round(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes);
void keep_round(const ColouredStage& stage, BatchRange batches);
/// What the impulses that the rows start from have changed becomes a part of the start.
void take_warm_start_round(const ColouredStage& stage, BatchRange batches);

void start_general(const ColouredStage& stage, BatchRange batches, LaneCount lanes);
double sweep_general(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes);
void keep_general(const ColouredStage& stage, BatchRange batches);
void take_warm_start_general(const ColouredStage& stage, BatchRange batches);

/// See LoadWork::work [mass units m^2/s^2]: of the impulses of a batch's rows.
double load_work_of_round(const ColouredStage& stage, std::uint32_t batch);
double load_work_of_general(const ColouredStage& stage, std::uint32_t batch);
void leave_part_of_round(const ColouredStage& stage, BatchRange batches, float part);
void leave_part_of_general(const ColouredStage& stage, BatchRange batches, float part);

}  // namespace tesserae
