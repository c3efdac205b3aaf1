// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// The cause of impulses. Those of an impact end in the sub-step in which they act. Those of a load
/// act again in the next sub-step, which starts from them.
enum class Cause {
    kImpact,  ///< bodies hit each other; before gravity acts
    kLoad,    ///< bodies rest on each other; after gravity has acted
};

/// The numbers that decide whether a contact is an impact, and what follows from it. They are the
/// same for all contacts of two bodies that share a normal.
struct Approach {
    double e = 0;        ///< coefficient of restitution
    double slowest = 0;  ///< approach speed above which it is an impact [m/s]
    double g = 0;        ///< acceleration of the bodies towards each other by gravity [m/s^2]
    double through = 0;  ///< overlap up to which the next sub-step still sees an impact [m]
};

/// How the load of an island takes overlap away: alone, or together with a position correction.
struct Parting {
    bool corrected = false;  ///< see is_corrected()
    double weight = 0;       ///< impulse of gravity on the island's bodies in a sub-step [N s]
    double part =
        1;  ///< part of kCorrectedBias that the load takes away beside a correction; see at()

    /// Returns the parting of one pair, whose `part` shrinks with the impulses that its contacts
    /// start from; without weight it is 0 for any load. Bodies that are too thick for the walls
    /// around them cannot part: every sweep would press them together more, and the next step go on
    /// from there, until they burst apart.
    Parting at(const StepData& step, Range contacts) const;
};
/// Returns the parting of an island's load.
Parting parting_of(const StepData& step, std::size_t island);

/// The targets of the contacts of two bodies that share a normal.
class PairTargets {
  public:
    /// @param contact   any of these contacts
    PairTargets(const Simulation& simulation, const StepData& step, const Contact& contact,
                Cause cause, const Parting& parting);
    /// Returns the targets of one contact.
    /// @param velocity   at which the bodies part along the normal before the cause's first impulse
    ///                   [m/s]
    /// @param rise       rise_of() the contact
    ContactTargets at(double separation, double velocity, double rise) const;
    /// Returns whether at() needs the velocity; otherwise it may be anything.
    bool need_velocity() const { return needs_approach_; }

  private:
    ContactTargets of_level(double separation, double velocity, double rise) const;
    ContactTargets of_overlap(double separation) const;

    Cause cause_;
    bool bounces_, needs_approach_;  ///< bounces_: some body has restitution
    double h_;                       ///< [s]
    double slop_;                    ///< overlap that is left alone [m]
    double fastest_;                 ///< greatest aim by which bodies are moved apart [m/s]
    double bias_;                    ///< the same for a load
    Approach approach_;
};

/// Returns the gap [m] up to which points of two bodies touch, see kRestingGap.
double resting_gap(const Simulation& simulation, BodyId a, BodyId b);

/// The velocity of body b relative to body a at the contact point [m/s].
/// @param turning   see Needs
inline Vec4 relative_velocity(const StepData& step, BodyId a, const Vec4& r_a, BodyId b,
                              const Vec4& r_b, bool turning) {
    if (!turning) return step.velocity[b] - step.velocity[a];
    return step.velocity[b] + velocity_at(step.angular_velocity[b], r_b) - step.velocity[a] -
           velocity_at(step.angular_velocity[a], r_a);
}

/// Returns the slip of a load's contact, of b relative to a [m/s], that comes in addition to the
/// velocities in the middle of the sub-step. Bodies go straight on with these velocities until the
/// middle of the next one. But a surface that turns with w goes along the chord of its way, as if
/// it moved by (h/2) w.u more; u is the other body's velocity relative to it. Without it, a body on
/// a turntable would move outward by (w h)^2/2 of its distance from the axis in every sub-step.
Vec4 slip_by_turning(const Simulation& simulation, const StepData& step, const Contact& contact,
                     Cause cause);
/// Returns the additional slip where the touching point runs along a rim, see aim_rims(). It is at
/// most as long as the slip, so that a load at most reverses the slip and adds no energy.
/// @param contacts   contacts of a pair in the list; the first one on a rim counts
/// @param velocity   of b relative to a there [m/s]
inline Vec4 slip_on_rim(const StepData& step, Range contacts, const Vec4& normal,
                        const Vec4& velocity, Cause cause) {
    if (cause == Cause::kImpact || step.rim_slips.empty()) return Vec4::Zero();
    std::size_t i = contacts.begin;
    while (i + 1 < contacts.end && step.rim_slips[i] == Vec4::Zero()) ++i;
    const Vec4& all = step.rim_slips[i];
    if (!(all.dot(velocity) > 0)) return Vec4::Zero();
    const double most = (velocity - normal.dot(velocity) * normal).norm(), length = all.norm();
    return length > most ? Vec4(most / length * all) : all;
}

/// The body whose turning counts in slip_by_turning(): the driven one, else the one that turns
/// less.
enum class TurningOf { kSlower, kA, kB };
inline TurningOf turning_of(const Simulation& simulation, BodyId a, BodyId b) {
    const bool of_a = is_driven(simulation, a), of_b = is_driven(simulation, b);
    return of_a == of_b ? TurningOf::kSlower : of_a ? TurningOf::kA : TurningOf::kB;
}
/// Returns the velocity of b relative to a before gravity acted [m/s]; along the normal the load
/// takes gravity's part back.
inline Vec4 velocity_before_gravity(const Simulation& simulation, const StepData& step, BodyId a,
                                    BodyId b) {
    const double kicks = simulation.type_of(b).gravity_scale - simulation.type_of(a).gravity_scale;
    return step.velocity[b] - step.velocity[a] - kicks * step.h * simulation.settings.gravity;
}

/// Returns whether some contact of the island overlaps by more than the slop while some body is
/// supported. A position correction then follows the load. It moves bodies without impulses, which
/// changes the angular momentum of bodies that move relative to each other; so islands that nothing
/// holds have none.
bool is_corrected(const Simulation& simulation, const StepData& step, std::size_t island);

/// Returns the energy that gravity gives an island's bodies in a sub-step from rest [J].
double energy_of_fall(const Simulation& simulation, const StepData& step, std::size_t island);

/// The strength of an island's impacts.
struct Impact {
    double fastest = 0;   ///< fastest approach [m/s]; 0: no impact
    double returned = 0;  ///< greatest part of such a speed that restitution gives back
    bool driven = false;  ///< some body moves at a velocity of its own; see is_driven()
};
/// Returns the strength of the impact of one contact, by its place in the list, without `driven`.
/// Needs the velocities before gravity.
Impact impact_of(const Simulation& simulation, const StepData& step, std::size_t place);

/// A quick test for points of a run that may be impacts.
class ImpactFilter {
  public:
    /// @param contact   any contact of the run
    ImpactFilter(const Simulation& simulation, const StepData& step, const Contact& contact);
    bool passes(const Vec4& point) const {
        // impact_of() rounds otherwise.
        return !(approach_ + turning_.dot(point - centre_) < 0.99 * slowest_);
    }

  private:
    Vec4 centre_, turning_ = Vec4::Zero();
    double approach_, slowest_;
};

}  // namespace tesserae
