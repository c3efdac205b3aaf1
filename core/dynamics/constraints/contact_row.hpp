#pragma once

#include <cmath>

#include "core/dynamics/constraints/contact_targets.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

double friction_of(const Simulation& simulation, BodyId a, BodyId b);

/// Below this part of what the bodies' inverse masses allow, a response is rounding: nothing there
/// can move (a sphere whose position is fixed, pushed through its centre) [1/kg].
double least_response(const Simulation& simulation, BodyId a, BodyId b);

/// Whether a body turns in the rest of the sub-step so that what a position correction has changed
/// of its turning has much more energy when it is given back, see kGivenBack: a needle that was
/// rolled a little about its length would be thrown across it.
/// @param turning   with the correction [rad/s]
bool turns_correction(const Simulation& simulation, const StepData& step, BodyId id,
                      const Bivector& turning, const Bivector& corrected);

/// The contact in the middle of the sub-step, but for what start_row() sets.
ContactRow make_row(const Simulation& simulation, const StepData& step, const Contact& contact);

/// Its targets and impulses. Needs the velocities before the first impulse of the cause.
/// @param place     of the contact in the list
/// @param impulse   where to start from
/// @param parting   of its pair
void start_row(const Simulation& simulation, const StepData& step, const Contact& contact,
               std::size_t place, const ContactImpulse& impulse, Cause cause,
               const Parting& parting, ContactRow& row);

/// The nearest impulse that friction allows.
inline Vec4 clamped_to_ball(const Vec4& impulse, double radius) {
    const double squared = impulse.squaredNorm();
    return squared > radius * radius ? Vec4(radius / std::sqrt(squared) * impulse) : impulse;
}

}  // namespace tesserae
