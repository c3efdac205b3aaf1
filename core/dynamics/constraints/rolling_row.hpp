// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Returns the greatest angular impulse against rolling, and the same against twisting, per normal
/// impulse of a contact [m]: the pair's larger rolling friction, or 0 for a pair without friction,
/// which has normal impulses only.
double rolling_arm_of(const Simulation& simulation, BodyId a, BodyId b);

/// Returns the rolling row of a contact in the middle of the sub-step, without its impulses.
RollingRow make_rolling_row(const Simulation& simulation, const StepData& step,
                            const ContactRow& contact);

/// Sets the first impulses of a rolling row: what the present normal and normal impulse leave of
/// `impulse` [N m s, on b].
void start_rolling_row(const ContactRow& contact, const Bivector& impulse, RollingRow& row);

/// Does one step for rolling, then one for twisting, with the contact's normal impulse in force.
/// Each is done as friction does it for the slip, see friction_impulse().
void solve_rolling_row(const Simulation& simulation, StepData& step, const ContactRow& contact,
                       RollingRow& row);

/// Applies an angular impulse [N m s, world] to b, and its opposite to a.
void apply_angular_impulse(const Simulation& simulation, StepData& step, BodyId a, BodyId b,
                           const Bivector& impulse);

/// Returns the angular impulse of both parts together [N m s, on b].
Bivector angular_impulse_of(const ContactRow& contact, const RollingRow& row);

}  // namespace tesserae
