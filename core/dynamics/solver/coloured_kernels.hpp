#pragma once

#include "core/dynamics/solver/sweep.hpp"
#include "core/dynamics/solver/targets.hpp"

namespace tesserae {

/// How many lanes of a batch are worked on at a time: the results are the same bits. Batches whose
/// pairs share movable bodies need kOne, which goes through the lanes in order.
enum class LaneCount { kOne, kEight };

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
    Cause cause;
    Parting parting;
    bool friction = true;  ///< false: without
    bool made = false;     ///< the rows are those of the blow before, but for what they start from
};

// Of round and of general batches: makes their rows and applies the impulses that they start from;
// one iteration; step.impulses of their contacts, or of a blow step.hit. Batches of one colour may
// be worked on at the same time.

void start_round(const ColouredStage& stage, BatchRange batches, LaneCount lanes);
/// @return the largest velocity_left() [m/s] if it is measured, else 0
double sweep_round(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes);
void keep_round(const ColouredStage& stage, BatchRange batches);
/// What the impulses that the rows start from have changed becomes a part of the start.
void take_recalled_round(const ColouredStage& stage, BatchRange batches);

void start_general(const ColouredStage& stage, BatchRange batches, LaneCount lanes);
double sweep_general(const ColouredStage& stage, BatchRange batches, Sweep sweep, LaneCount lanes);
void keep_general(const ColouredStage& stage, BatchRange batches);
void take_recalled_general(const ColouredStage& stage, BatchRange batches);
/// Of what whirls() nothing is taken back; bodies that are round on both sides do not.
void leave_whirling_general(const ColouredStage& stage, BatchRange batches);

/// See LoadWork::work [mass units m^2/s^2]: of the impulses of a batch's rows.
double load_work_of_round(const ColouredStage& stage, std::uint32_t batch, Pass pass);
double load_work_of_general(const ColouredStage& stage, std::uint32_t batch, Pass pass);
void leave_part_of_round(const ColouredStage& stage, BatchRange batches, float part);
void leave_part_of_general(const ColouredStage& stage, BatchRange batches, float part);

}  // namespace tesserae
