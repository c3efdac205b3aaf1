#pragma once

#include <cmath>

#include "core/dynamics/state/step_data.hpp"

namespace tesserae {

/// Part of an overlap that a sub-step of Solver::kImpulse removes (f in the bias
/// -(f/h) min(0, s + a)), usual 0.2. Towards 1 stacks jump, towards 0 they sink.
constexpr double kBiasPart = 0.2;

/// The spring of Solver::kSoft: cycles in a sub-step, usual 0.25, and the part of critical damping,
/// usual 10 (E. Catto, "Solver2D", 2024). Stiffer, and stacks jump; softer, and they sink.
constexpr double kSpringCycles = 0.25, kSpringDamping = 10;

/// Speed at which overlapping bodies are moved apart, at most, in least half-sizes a second (and
/// what gravity adds in a sub-step): so that those that start deep inside each other do not
/// explode. Less, and a heavy load sinks in.
constexpr double kLargestPush = 4;

/// Approach speed above which restitution acts, as a multiple of what gravity adds in a sub-step:
/// slower bounces would last fewer than 8 sub-steps. Lower, resting bodies rattle; higher, bouncing
/// ends too soon. Where there is no gravity every approach bounces.
constexpr double kRestitutionKicks = 4;

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

/// Of b against a at the contact point [m/s].
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
