// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

// These functions are called for every island. Small coloured islands are solved in groups, with
// the first of each group; for the others nothing is left to do.

/// Applies the impacts of an island: bodies that approach each other faster than resting ones do
/// are stopped (compression), then thrown back by their restitution, see part_of_restitution().
/// Call it before gravity is added. Its impulses are not kept: the next sub-step starts from the
/// load alone.
void solve_impact(const Simulation& simulation, StepData& step, std::size_t island);

/// Solves the load of an island by sequential impulses, which are accumulated, clamped and warm
/// started. It goes through the contacts in the order that Islands gives and changes the velocities
/// of the island's movable bodies, and of no others. Coloured islands are solved by
/// solve_coloured_island(). Source: E. Catto, "Iterative dynamics with temporal coherence", 2005;
/// here friction is a block of three directions instead of separate ones.
void solve_island(const Simulation& simulation, StepData& step, std::size_t island);

/// Moves the island's bodies by its position correction, once they have moved by their velocities,
/// of which it is no part (split impulses: Guendelman et al., "Nonconvex rigid bodies with
/// stacking", 2003).
void apply_correction(const Simulation& simulation, StepData& step, std::size_t island);

}  // namespace tesserae
