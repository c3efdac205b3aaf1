#pragma once

#include "core/dynamics/step_data.hpp"

namespace tesserae {

/// Part of an overlap that a step removes (f in the bias -(f/h) min(0, s + a)), usual 0.2. Towards
/// 1 stacks jump, towards 0 they sink.
constexpr double kBiasPart = 0.2;

/// Approach speed [m/s] above which restitution acts, that of a fall from 3 mm. Lower, resting
/// bodies rattle; higher, bouncing ends too soon.
constexpr double kRestitutionThreshold = 0.25;

/// step.impulses of the contacts in the range: what the last step's memory holds for the same
/// (a, b, feature), else zero.
void recall_impulses(const Simulation& simulation, StepData& step, Range contacts);

/// Solves the contacts of one island by sequential impulses, accumulated and clamped, warm
/// started: changes the velocities of its movable bodies and leaves its contacts' impulses in
/// step.impulses. Touches nothing of another island. Source: E. Catto, "Iterative dynamics with
/// temporal coherence", 2005; friction is a block of three directions instead of separate ones.
void solve_island(const Simulation& simulation, StepData& step, std::size_t island);

}  // namespace tesserae
