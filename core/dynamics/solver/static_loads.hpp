// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Sets step.impulses of an island to the load that holds its bodies still, if a few bodies creep
/// on something that supports them, as a tower does. The load is solved directly. A high pile bends
/// like a beam: sweeps need some n^4 iterations to see that n bodies lean; until then the pile
/// sways, and a small one falls. The sweeps then go on from this load, with their own aims.
///
/// Among the impulses at touching points that leave the least kinetic energy, these are the least
/// (method of multipliers: Nocedal and Wright, "Numerical optimization", 2006, 17.3). Points that
/// would pull let go, points with too little friction slip, and the rest is solved again. So
/// contacts only push and friction obeys Coulomb's law, as with sweeps.
///
/// It does nothing for an island that takes too much work (kStaticWork: walls, heaps), has rolling
/// friction or joints, moves so fast that bodies bounce (kRestitutionKicks) or is not supported.
void hold_still(const Simulation& simulation, StepData& step, std::size_t island);

}  // namespace tesserae
