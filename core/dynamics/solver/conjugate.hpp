#pragma once

#include "core/dynamics/solver/kernels/kernels.hpp"

namespace tesserae {

// Conjugate directions of the sweeps over coloured islands' loads (Hestenes and Stiefel 1952; of
// contacts: Silcowitz, Niebe and Erleben 2010). While no contact opens and none slips, loads are
// the solution of a linear system, the least of an energy. A pair of sweeps, backward and forward,
// each the adjoint of the other, leads from impulses x to x + z, the gradient there, preconditioned
// by symmetric Gauss-Seidel. The next pair begins not with x + z but with x + a p, in a direction
// p = z + b p_last that is conjugate to the one before, and as far along it as takes the most
// energy. So errors that spread over many bodies, as a high wall's sway, are gone in as many pairs
// as there are kinds of them, and not in thousands of sweeps.
//
// Where contacts open or slip the system is another one, and a step along p may lead away from its
// solution. The energy at the end of a pair, which else only falls, then rises, and the direction
// is given up for a pair of sweeps, the next time for two, then for four, and so on.
//
// With r the gradient's opposite, b = r.z/(r.z)_last and a = r.p/p.Ap. p.Ap is twice the kinetic
// energy of what p does to the bodies; -r.p is what p does to them times the momentum of what x has
// done, and p times the rows' velocities at the start, less their targets. The start is where the
// warm start's impulses have acted: what they and gravity do is much more than what is left to
// solve, and the rounding of so much would be what slopes are made of (a wall then sways by 4
// mm/s).

/// Whether the load of an island goes along conjugate directions if all of its pairs are such:
/// friction is not so strong that what a sweep changes may grow, see kMostConjugateFriction, and
/// there is no rolling friction, which what rolls has its full share of, so that no direction leads
/// anywhere.
bool has_conjugates(const Simulation& simulation, BodyId a, BodyId b);

/// The energies of what the impulses that the load starts from have changed, and of what gravity
/// has.
BodySums weigh_warm_start(const ColouredStage& stage, Range bodies);
/// Before the rows' work on that is weighed, as that of a step from no impulses.
void begin_warm_start_round(const ColouredStage& stage, BatchRange batches);
void begin_warm_start_general(const ColouredStage& stage, BatchRange batches);

/// The warm start is kept apart and no change any more: what is left is small, and so is its
/// rounding, of which directions would grow. The rows' starts have it first, by
/// take_warm_start_round() and take_warm_start_general(), and the velocities, by add_changes().
void take_warm_start(const ColouredStage& stage, Range bodies);

/// What the next pair of sweeps goes on from, without a direction: where the last one ended.
void begin_directions(const ColouredStage& stage, Range bodies);
void begin_round_directions(const ColouredStage& stage, BatchRange batches);
void begin_general_directions(const ColouredStage& stage, BatchRange batches);

/// After a pair: r.z, r.p_last and the energy at its end: of bodies; of each batch, into round_work
/// and general_work, r.z and the energy.
BodySums weigh_step(const ColouredStage& stage, Range bodies);
void weigh_round_step(const ColouredStage& stage, BatchRange batches);
void weigh_general_step(const ColouredStage& stage, BatchRange batches);

/// The bodies' part of the new direction.
/// @param carried   b
/// @return p.Ap and the largest square of a change of velocity
BodySums find_direction(const ColouredStage& stage, Range bodies, float carried);

/// The beginning of the next pair.
/// @param length   a
void go_along(const ColouredStage& stage, Range bodies, float length);
void go_along_round(const ColouredStage& stage, BatchRange batches, float carried, float length);
void go_along_general(const ColouredStage& stage, BatchRange batches, float carried, float length);

}  // namespace tesserae
