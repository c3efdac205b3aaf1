// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// The free motion of a body over a half of a sub-step or another time, and when it is stopped on
/// its way.
class FreePath {
  public:
    /// Finds the path that led the body to its present pose, back along its present velocities:
    /// free motion can be reversed (to second order with RotationIntegrator::kEuler).
    FreePath(const Simulation& simulation, const StepData& step, BodyId id)
        : FreePath(simulation, step, id, 0.5 * step.h, 0.5 * step.h) {}
    /// Finds the path of a body that moved for a part of the time only, and then stood still.
    /// @param moved      [s], >= 0
    /// @param duration   of the path [s], >= moved
    FreePath(const Simulation& simulation, const StepData& step, BodyId id, double moved,
             double duration);

    /// Stops the body from this time on [s].
    void stop(double time) { stop_ = time; }
    bool moves(double time) const { return time < stop_; }
    /// How much of a time from `time` to the end it turns [s].
    double turns_for(double time) const { return std::max(0.0, std::min(stop_, turning_) - time); }

    struct State {
        Vec4 position;
        Rotor rotor;
        Bivector angular_velocity;
    };
    /// Returns the body's state at a time since the path began [s].
    State at(double time) const;
    Vec4 position_at(double time) const {
        return start_.position + std::min(time, stop_) * velocity_;
    }

    BodyId id() const { return id_; }
    const Shape& shape() const { return *shape_; }
    /// The body's least half-size [m]; infinite if unbounded.
    double half_size() const { return type_->slop / kSlop; }
    /// Of the ball about its centre that holds it [m].
    double radius() const { return type_->bounded ? type_->radius : kNever; }
    const Vec4& velocity() const { return velocity_; }
    /// Bound of the speed at which turning moves a point of the surface towards another body [m/s].
    double spin() const { return spin_; }
    /// Bound of the acceleration of such a point by turning [m/s^2].
    double swing() const { return swing_; }
    double duration() const { return duration_; }

  private:
    static constexpr double kNever = std::numeric_limits<double>::infinity();

    void bound_turning();
    void put_waypoints();

    BodyId id_;
    const Shape* shape_;
    const TypeProperties* type_;
    RotationIntegrator integrator_;
    double duration_;
    double stop_ = kNever;
    double turning_ = kNever;  ///< until when it turns [s]
    double spin_ = 0, swing_ = 0;
    Vec4 velocity_;
    State start_;
    double between_ = kNever;       ///< of waypoints [s]
    std::vector<State> waypoints_;  ///< where at() starts from, but for the first, which is start_
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

/// The most advances of a search for an impact, before and after the time when the bodies touch.
/// Usual 1000; a rod of 1 m by 1 mm that whirls beside a wall takes some 50. Fewer: what whirls
/// near other bodies is stopped though it does not hit them.
constexpr std::size_t kMostAdvances = 1000;

/// What searches for impacts share: memory, and how much they have cost.
struct ImpactSearch {
    std::vector<Contact> contacts;
    std::size_t gaps = 0;              ///< of how many poses of two bodies the gap was found
    std::size_t most = kMostAdvances;  ///< advances of a search, twice; of none it finds `from`
};

/// Returns whether two bodies may pass through each other from a time on, by what is cheap to know:
/// how far they move, and whether the balls about them meet.
bool may_pass(const FreePath& a, const FreePath& b, double from);

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
/// @param from      time since the paths began [s]; the bodies are known not to pass before it
///
/// A search that ends before it is sure finds the last time at which they surely do not touch.
/// @return [s], from <= t <= duration, or kNoImpact
double impact_time(const FreePath& a, const FreePath& b, double from, ImpactSearch& search);

}  // namespace tesserae
