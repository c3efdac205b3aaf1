// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// The free motion of a body over a half of a sub-step, and when it is stopped on its way.
class FreePath {
  public:
    /// Finds the path that led the body to its present pose, back along its present velocities:
    /// free motion can be reversed (to second order with RotationIntegrator::kEuler).
    FreePath(const Simulation& simulation, const StepData& step, BodyId id);

    /// Stops the body from this time on [s].
    void stop(double time) { stop_ = time; }
    bool moves(double time) const { return time < stop_; }

    struct State {
        Vec4 position;
        Rotor rotor;
        Bivector angular_velocity;
    };
    /// Returns the body's state at a time since the half began [s].
    State at(double time) const;

    BodyId id() const { return id_; }
    const Shape& shape() const { return *shape_; }
    /// The body's least half-size [m]; infinite if unbounded.
    double half_size() const { return type_->slop / kSlop; }
    const Vec4& velocity() const { return velocity_; }
    /// Bound of the speed at which turning moves a point of the surface towards another body [m/s].
    double spin() const { return spin_; }
    /// Bound of the acceleration of such a point by turning [m/s^2].
    double swing() const { return swing_; }
    double duration() const { return duration_; }

  private:
    void bound_turning();

    BodyId id_;
    const Shape* shape_;
    const TypeProperties* type_;
    RotationIntegrator integrator_;
    double duration_;
    double stop_ = std::numeric_limits<double>::infinity();
    double spin_ = 0, swing_ = 0;
    Vec4 velocity_;
    State start_;
};

/// Returns whether a body moves so far in half a sub-step, at its present speed, that it might pass
/// through another body.
inline bool is_fast(const Simulation& simulation, const StepData& step, BodyId id) {
    const TypeProperties& type = simulation.type_of(id);
    if (!type.bounded) return false;
    // Every body is asked twice a sub-step: without roots, which few need.
    const double half = 0.5 * step.h, most = kDeepest / kSlop * type.slop;
    const double way_squared = half * half * step.velocity[id].squaredNorm();
    if (!(type.arm > 0)) return way_squared > most * most;
    const Bivector& omega = step.angular_velocity[id];
    const double spin_squared = half * half * type.arm * type.arm * dot(omega, omega);
    if (2 * (way_squared + spin_squared) <= most * most) return false;
    return std::sqrt(way_squared) + std::sqrt(spin_squared) > most;
}

constexpr double kNoImpact = std::numeric_limits<double>::infinity();

/// Returns the time at which two bodies have to be stopped so that they do not pass through each
/// other.
///
/// At this time they first touch: they are kTouch of twice their least half-size apart, or overlap
/// so much more than at `from`. They are stopped only if they would overlap by more than kDeepest
/// of the same size, so bodies that slide, roll or spin on each other or hit slowly are not. The
/// method is conservative advancement (Mirtich 1996) along the normals that the pair's contact
/// function finds: the gap along a fixed normal is a lower bound of the distance, whatever the
/// shapes.
/// @param from      time since the half began [s]; the bodies are known not to pass before it
/// @param scratch   a list whose memory is used
/// @return [s], from <= t <= duration, or kNoImpact
double impact_time(const FreePath& a, const FreePath& b, double from,
                   std::vector<Contact>& scratch);

}  // namespace tesserae
