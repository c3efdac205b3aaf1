// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/solver/kernels/kernels.hpp"

namespace tesserae {

// Conjugate directions of the sweeps over coloured islands' loads (Hestenes and Stiefel 1952; for
// contacts: Silcowitz, Niebe and Erleben 2010). While no contact opens or slips, a load is the
// solution of a linear system, the minimum of an energy. A pair of sweeps, backward and forward,
// each the adjoint of the other, leads from impulses x to x + z: the gradient there, preconditioned
// by symmetric Gauss-Seidel. The next pair begins not at x + z but at x + a p. The direction
// p = z + b p_last is conjugate to the one before, and a is the length that takes the most energy.
// So errors that spread over many bodies, as the sway of a high wall, are gone in as many pairs as
// there are kinds of them, and not in thousands of sweeps.
//
// Where contacts open or slip, the system changes, and a step along p may lead away from its
// solution. The energy at the end of a pair, which otherwise only falls, then rises. The direction
// is then given up for a pair of sweeps, the next time for two, then for four, and so on.
//
// With r the negative gradient, b = r.z/(r.z)_last and a = r.p/p.Ap. p.Ap is twice the kinetic
// energy of what p does to the bodies. -r.p has two parts: what p does to the bodies times the
// momentum of what x has done, and p times the rows' velocities at the start, less their targets.
// The start is after the warm start has acted: the warm start and gravity do much more than what is
// left to solve, and slopes would be made of its rounding, so that walls sway.

/// Returns whether a pair of bodies in contact allows conjugate directions; an island has them if
/// all of its pairs do, no constraint gives way, and no driven body may squeeze its bodies.
/// Friction must be at most kMostConjugateFriction, or what a sweep changes may grow. There must be
/// no rolling friction: bodies that roll have all of it that is allowed, so that no direction leads
/// anywhere.
bool has_conjugates(const Simulation& simulation, BodyId a, BodyId b);

/// Returns two energies of an island's bodies: of the changes by the warm start, and of those by
/// gravity.
/// @param mass_unit   [kg]
BodySums weigh_warm_start(const ColouredStage& stage, Range bodies, double mass_unit);
/// Prepares the rows so that the next weighing counts the warm start as one step from no impulses.
void begin_warm_start_round(const ColouredStage& stage, BatchRange batches, Members some);
void begin_warm_start_general(const ColouredStage& stage, BatchRange batches, Members some);
void begin_warm_start_others(const ColouredStage& stage, BatchRange some);

/// Moves the warm start from the bodies' changes to a record of its own. The changes that remain
/// are small, and so is their rounding, from which directions would grow. Call
/// take_warm_start_round(), take_warm_start_general() and add_changes() before it: rows' starts and
/// velocities then have the warm start.
void take_warm_start(const ColouredStage& stage, Range bodies);

/// Starts the next pair of sweeps where the last one ended, without a direction.
void begin_directions(const ColouredStage& stage, Range bodies);

/// Weighs a pair of sweeps once it has ended. Returns the bodies' part of r.z, r.p_last and the
/// energy; the functions for rows write each batch's part of r.z and the energy to round_work,
/// general_work and others_work, or each lane's where islands share batches.
BodySums weigh_step(const ColouredStage& stage, Range bodies);
void weigh_round_step(const ColouredStage& stage, BatchRange batches);
void weigh_general_step(const ColouredStage& stage, BatchRange batches);
void weigh_others_step(const ColouredStage& stage, BatchRange some);

/// Finds the bodies' part of the new direction.
/// @param carried   b
/// @return p.Ap and the largest square of a change of velocity
BodySums find_direction(const ColouredStage& stage, Range bodies, float carried);

/// Where each island's next pair of sweeps starts: at x + a p if it has a direction, else where the
/// last one ended.
struct DirectionSteps {
    PerMember<float> carried, length;  ///< b and a
    Members along;                     ///< islands that have a direction
};
/// Starts the next pair of sweeps at x + a p.
/// @param length   a
void go_along(const ColouredStage& stage, Range bodies, float length);
/// Starts the next pair of sweeps.
void go_along_round(const ColouredStage& stage, BatchRange batches, const DirectionSteps& steps);
void go_along_general(const ColouredStage& stage, BatchRange batches, const DirectionSteps& steps);
void go_along_others(const ColouredStage& stage, BatchRange some, const DirectionSteps& steps);

}  // namespace tesserae
