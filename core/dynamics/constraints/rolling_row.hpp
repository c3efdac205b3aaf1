#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// How far, as a part of a contact's normal impulse, the impulses against rolling and against
/// twisting may each go [m]: the larger rolling friction, or 0 for a pair without friction, which
/// touches by normal impulses alone.
double rolling_arm_of(const Simulation& simulation, BodyId a, BodyId b);

/// The row of a contact in the middle of the sub-step, but for its impulses.
RollingRow make_rolling_row(const Simulation& simulation, const StepData& step,
                            const ContactRow& contact);

/// Its impulses, from those of the last normal: what is left of `impulse` [N m s, on b].
void start_rolling_row(const ContactRow& contact, const Bivector& impulse, RollingRow& row);

/// Rolling, then twisting, with the contact's normal impulse in force: each as friction does with
/// the slip, see friction_impulse().
void solve_rolling_row(const Simulation& simulation, StepData& step, const ContactRow& contact,
                       RollingRow& row);

/// Applies an angular impulse [N m s, world] to b, and its opposite to a.
void apply_angular_impulse(const Simulation& simulation, StepData& step, BodyId a, BodyId b,
                           const Bivector& impulse);

/// Both parts together [N m s, on b].
Bivector angular_impulse_of(const ContactRow& contact, const RollingRow& row);

}  // namespace tesserae
