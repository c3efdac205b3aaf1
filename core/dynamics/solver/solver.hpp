#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// If bodies of the island hit each other in this sub-step: the change of their motion by it. Needs
/// the velocities before gravity. First the compression, until no bodies meet, then the restitution
/// (part_of_restitution()). Its impulses are not kept: what is started from in the next sub-step is
/// the load alone.
void solve_impact(const Simulation& simulation, StepData& step, std::size_t island);

/// Solves the contacts of one island by sequential impulses, accumulated and clamped, warm
/// started, in the order that Islands gives: changes the velocities of its movable bodies. Touches
/// nothing of another island. A coloured one is solved by solve_coloured_island(). Source: E.
/// Catto, "Iterative dynamics with temporal coherence", 2005; friction is a block of three
/// directions instead of separate ones.
void solve_island(const Simulation& simulation, StepData& step, std::size_t island);

/// Takes back the part of the velocities that only took overlap away, once the island's bodies have
/// moved by it (as split impulses: Guendelman et al., "Nonconvex rigid bodies with stacking",
/// 2003).
void drop_correction(const Simulation& simulation, StepData& step, std::size_t island);

}  // namespace tesserae
