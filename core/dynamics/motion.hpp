#pragma once

#include "core/dynamics/step_data.hpp"

namespace tesserae {

/// Half a step of free motion at the present velocities, of the bodies in the range. The first half
/// starts from the last state. With the velocities changed between the two halves a step moves
/// x += h (v0 + v1) / 2, which is exact under constant gravity. Bodies that turn freely keep their
/// angular momentum, so that their angular velocity changes with the rotor (the gyroscopic term);
/// Integrator says by which angular velocity a half turns.
void advance_first_half(const Simulation& simulation, StepData& step, Range bodies);
void advance_second_half(const Simulation& simulation, StepData& step, Range bodies);

/// Gravity over the whole step, on the bodies that fall.
void integrate_velocities(const Simulation& simulation, StepData& step, Range bodies);

/// Bounds of where each body is in the middle of the step and where its velocity takes it within
/// one step from there: a contact is then seen before the bodies can pass through each other.
void update_bounds(const Simulation& simulation, StepData& step, Range bodies);

}  // namespace tesserae
