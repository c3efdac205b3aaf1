#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Half a sub-step of free motion at the present velocities, of the bodies in the range. The first
/// half of the first sub-step starts from the last state. With the velocities changed between the
/// two halves a sub-step moves x += h (v0 + v1) / 2, which is exact under constant gravity. Bodies
/// that turn freely keep their angular momentum: turn_freely(). The first half ends where contacts
/// act, and leaves there step.inverse_inertia of the bodies that are awake.
/// @return whether any is fast: see Impacts
bool advance_first_half(const Simulation& simulation, StepData& step, Range bodies);
bool advance_second_half(const Simulation& simulation, StepData& step, Range bodies);

/// step.inverse_inertia of a body as it is turned now; none if it is isotropic.
void set_inverse_inertia(const Simulation& simulation, StepData& step, BodyId id);

/// Gravity over the whole sub-step, on the bodies that fall and are awake.
void integrate_velocities(const Simulation& simulation, StepData& step, Range bodies);

/// Bounds of where each body is in the middle of the sub-step and where its velocity and gravity
/// take it from there in the time until the next step's first middle: a contact is then seen before
/// the bodies can pass through each other.
void update_bounds(const Simulation& simulation, StepData& step, Range bodies);

/// Whether a body of the range, made faster by a contact, can leave the ball in its bounds in this
/// sub-step, so that they and the pairs are to be found anew.
bool outgrows_bounds(const Simulation& simulation, const StepData& step, Range bodies);

/// Whether a body of the range, made faster by a contact, has come out of its bounds in the second
/// half.
bool has_left_bounds(const Simulation& simulation, const StepData& step, Range bodies);

}  // namespace tesserae
