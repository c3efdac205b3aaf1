// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/dynamics/constraints/contact_targets.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Returns the friction coefficient of a pair: the geometric mean of both bodies' coefficients.
double friction_of(const Simulation& simulation, BodyId a, BodyId b);

/// Returns the response of a pair [1/kg] below which it is only rounding and nothing can move, as
/// when a sphere whose position is fixed is pushed through its centre.
double least_response(const Simulation& simulation, BodyId a, BodyId b);

/// Returns the row of a contact in the middle of the sub-step, without what start_row() sets.
ContactRow make_row(const Simulation& simulation, const StepData& step, const Contact& contact);

/// Sets the targets and the first impulses of a row. Needs the velocities before the first impulse
/// of the cause.
/// @param place     place of the contact in the list
/// @param impulse   impulse to start from
/// @param parting   how the load of its pair takes overlap away
void start_row(const Simulation& simulation, const StepData& step, const Contact& contact,
               std::size_t place, const ContactImpulse& impulse, Cause cause,
               const Parting& parting, ContactRow& row);

/// Returns the impulse nearest to a given one that friction allows: at most `radius` long.
inline Vec4 clamped_to_ball(const Vec4& impulse, double radius) {
    const double squared = impulse.squaredNorm();
    return squared > radius * radius ? Vec4(radius / std::sqrt(squared) * impulse) : impulse;
}

}  // namespace tesserae
