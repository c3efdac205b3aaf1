#pragma once

#include <cmath>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/state/step_data.hpp"

namespace tesserae {

/// What a row aims at, along the normal; see NormalPass.
struct ContactTargets {
    double keep = 1;   ///< of the solve pass
    double solve = 0;  ///< [m/s]
    double relax = 0;  ///< [m/s]
};
/// @param normal_velocity   at which the bodies part, as make_row() needs the velocities [m/s]
ContactTargets targets_of(const Simulation& simulation, const StepData& step,
                          const Contact& contact, double normal_velocity);

double friction_of(const Simulation& simulation, BodyId a, BodyId b);

/// Below this part of what the bodies' inverse masses allow, a response is rounding: nothing there
/// can move (a sphere whose position is fixed, pushed through its centre) [1/kg].
double least_response(const Simulation& simulation, BodyId a, BodyId b);

/// The contact in the middle of the sub-step. Needs the velocities before any impulse of the
/// sub-step and after gravity.
/// @param impulse   where to start from
ContactRow make_row(const Simulation& simulation, const StepData& step, const Contact& contact,
                    const ContactImpulse& impulse);

/// The velocity of body b relative to body a at the contact point [m/s].
/// @param turning   see Needs
inline Vec4 relative_velocity(const StepData& step, BodyId a, const Vec4& r_a, BodyId b,
                              const Vec4& r_b, bool turning) {
    if (!turning) return step.velocity[b] - step.velocity[a];
    return step.velocity[b] + velocity_at(step.angular_velocity[b], r_b) - step.velocity[a] -
           velocity_at(step.angular_velocity[a], r_a);
}

/// The nearest impulse that friction allows.
inline Vec4 clamped_to_ball(const Vec4& impulse, double radius) {
    const double squared = impulse.squaredNorm();
    return squared > radius * radius ? Vec4(radius / std::sqrt(squared) * impulse) : impulse;
}

}  // namespace tesserae
