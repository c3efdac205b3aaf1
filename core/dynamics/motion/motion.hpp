// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Moves the bodies in the range freely for the first half of a sub-step, at their present
/// velocities. In the first sub-step it starts from the last state. Velocities change between the
/// two halves, so that a sub-step moves x += h (v0 + v1) / 2, which is exact under constant
/// gravity. Bodies that turn freely keep their angular momentum, see turn_freely(). The first half
/// ends where contacts act and writes step.inverse_inertia there, of the bodies that are awake.
/// @return whether any body is fast, see is_fast()
bool advance_first_half(const Simulation& simulation, StepData& step, Range bodies);
/// Moves the bodies in the range freely for the second half of a sub-step.
/// @return whether any body is fast, see is_fast()
bool advance_second_half(const Simulation& simulation, StepData& step, Range bodies);

/// Moves a body for half a sub-step by a motion that it does not keep, as of a position correction,
/// but not so far that it might pass through another body, see is_fast(). Its velocity stays, and
/// its angular velocity turns with it, so that it keeps its energy.
void displace(const Simulation& simulation, StepData& step, BodyId id, const BodyMotion& motion);

/// Writes step.inverse_inertia of a body for its present rotor. An isotropic body has none.
void set_inverse_inertia(const Simulation& simulation, StepData& step, BodyId id);

/// Adds gravity's change of velocity over the whole sub-step, for bodies that are awake.
void integrate_velocities(const Simulation& simulation, StepData& step, Range bodies);

/// Damps velocities over half a sub-step. This acts at both ends of a sub-step, where contacts do
/// not: what rests has no velocity there, and its load is its whole weight.
void damp_half(const Simulation& simulation, StepData& step, Range bodies);

/// Returns how far from a body's centre its surface can get within a time, and its slop farther
/// [m].
double reach(const Simulation& simulation, const StepData& step, BodyId id, double time);

/// Writes step.bounds: each encloses where a body is in the middle of the sub-step and where its
/// velocity and gravity take it until the first middle of the next step. A contact is then seen
/// before bodies can pass through each other.
void update_bounds(const Simulation& simulation, StepData& step, Range bodies);

/// Returns whether a body of the range, made faster by a contact, can leave its bounds in this
/// sub-step. Bounds and pairs must then be found anew.
bool outgrows_bounds(const Simulation& simulation, const StepData& step, Range bodies);

/// Returns whether a body of the range, made faster by a contact, has left its bounds in the second
/// half.
bool has_left_bounds(const Simulation& simulation, const StepData& step, Range bodies);

}  // namespace tesserae
