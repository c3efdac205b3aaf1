#pragma once

#include "core/dynamics/solver/coloured_kernels.hpp"

namespace tesserae {

// Momentum of an iteration, of coloured islands' loads: a pair of sweeps, one each way, begins not
// with what the pair before it ended with, x, but with x + kMomentum (x - what that began from).
// Velocities are linear in impulses, so that both go on alike. Errors that spread over many bodies,
// as a high wall's sway, shrink many times faster (Nesterov 1983; Mazhar et al. 2015 for contacts).
// Where a pair turns back from where it began, the momentum is given up for once (O'Donoghue and
// Candes 2015).

/// Whether friction is nowhere so strong that what a sweep changes may grow: see
/// kMostMomentumFriction.
bool bears_momentum(const Simulation& simulation);

/// What the first pair of sweeps goes on from.
void begin_momentum(const ColouredStage& stage, Range bodies);
void begin_round_momentum(const ColouredStage& stage, BatchRange batches);
void begin_general_momentum(const ColouredStage& stage, BatchRange batches);

/// How far the last pair of sweeps turned back from its beginning, along the way of its result:
/// sums of masses times velocities squared, into turned_back of the bodies.
void measure_turning_back(const ColouredStage& stage, Range bodies);

/// The beginning of the next pair.
/// @param part   kMomentum, or 0
void carry_on(const ColouredStage& stage, Range bodies, float part);
void carry_on_round(const ColouredStage& stage, BatchRange batches, float part);
void carry_on_general(const ColouredStage& stage, BatchRange batches, float part);

}  // namespace tesserae
