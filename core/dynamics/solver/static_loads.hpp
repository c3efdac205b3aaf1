#pragma once

#include <cstddef>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Where a few bodies creep on what holds them, as a tower does: step.impulses of the island become
/// the load that holds them still, solved at once. A high pile bends like a beam: it takes sweeps
/// some n^4 of n bodies to see that it leans, until then it sways, and what is small has fallen
/// before. The sweeps then go on from this load, with their own aims.
///
/// Of the impulses at the points that touch that leave the least motion, in the norm of the kinetic
/// energy, these are the least (the method of multipliers: Nocedal and Wright, "Numerical
/// optimization", 2006, 17.3). Points that would pull let go and those whose friction does not
/// reach slip, and what is left is solved again: as with sweeps, contacts only push, and friction
/// is at most that of Coulomb's law.
///
/// Not for what takes too much work (kStaticWork: walls, heaps), has rolling friction, is jammed
/// (kPartedWeight), has just been hit or moves faster than gravity makes it in a sub-step; not
/// where nothing is held, and not with fewer sweeps than by default.
void hold_still(const Simulation& simulation, StepData& step, std::size_t island);

}  // namespace tesserae
