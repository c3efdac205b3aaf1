#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// What impulses are for. Those of an impact end in the sub-step in which they act; those of a load
/// act again in the next one, which starts from them.
enum class Cause {
    kImpact,  ///< bodies hit each other; before gravity acts
    kLoad,    ///< they rest on each other; after it
};

/// What decides whether a contact is an impact, and what follows: the same for all of two bodies
/// that have one normal.
struct Approach {
    double e = 0;        ///< coefficient of restitution
    double slowest = 0;  ///< speed above which it is one [m/s]
    double g = 0;        ///< at which gravity accelerates the bodies towards each other [m/s^2]
    double through = 0;  ///< how deep they may overlap until the next sub-step sees it as one [m]
};

/// How the load of an island takes overlap away: by itself, or as far as a position correction does
/// not.
struct Parting {
    bool corrected = false;  ///< see is_corrected()
    double weight = 0;       ///< impulse of gravity on the island's bodies in a sub-step [N s]
    double part = 1;         ///< of what the load does beside a correction; see at()

    /// Of contacts of one pair, by the impulses that they start from; without weight none is left
    /// beside any. Where bodies cannot part, as where they are too thick for the walls between
    /// which they start, every sweep presses them together more, and the next step goes on from
    /// there, until they burst apart.
    Parting at(const StepData& step, Range contacts) const;
};
Parting parting_of(const StepData& step, std::size_t island);

/// The targets of the contacts of two bodies that have one normal.
class PairTargets {
  public:
    /// @param contact   any of them
    PairTargets(const Simulation& simulation, const StepData& step, const Contact& contact,
                Cause cause, const Parting& parting);
    /// @param velocity   along the normal, at which the bodies part before the first impulse of the
    ///                   cause [m/s]
    /// @param rise       rise_of() the contact
    ContactTargets at(double separation, double velocity, double rise) const;
    /// Else the velocity may be anything.
    bool need_velocity() const { return needs_approach_; }

  private:
    ContactTargets of_level(double separation, double velocity, double rise) const;
    ContactTargets of_overlap(double separation) const;

    Cause cause_;
    bool bounces_, needs_approach_;  ///< bounces_: of any pair
    double h_;                       ///< [s]
    double slop_;                    ///< overlap that is left alone [m]
    double fastest_;                 ///< at which bodies are moved apart, at most [m/s]
    double bias_;                    ///< the same of a load
    Approach approach_;
};

/// Points of two bodies that are no farther apart touch, see kRestingGap [m].
double resting_gap(const Simulation& simulation, BodyId a, BodyId b);

/// The velocity of body b relative to body a at the contact point [m/s].
/// @param turning   see Needs
inline Vec4 relative_velocity(const StepData& step, BodyId a, const Vec4& r_a, BodyId b,
                              const Vec4& r_b, bool turning) {
    if (!turning) return step.velocity[b] - step.velocity[a];
    return step.velocity[b] + velocity_at(step.angular_velocity[b], r_b) - step.velocity[a] -
           velocity_at(step.angular_velocity[a], r_a);
}

/// What the slip of a load's contact, of b against a [m/s], has beyond that of the velocities in
/// the middle of the sub-step: bodies go straight on with these until the middle of the next one,
/// but a surface that turns with w goes along the chord of its way, as if it moved by (h/2) w.u
/// more, where u is how the other body moves against it. Without, what stands on a turntable comes
/// out by (w h)^2/2 of its distance from the axis in every sub-step.
Vec4 slip_by_turning(const Simulation& simulation, const StepData& step, const Contact& contact,
                     Cause cause);
/// The same where the point at which a rim touches runs along it: see aim_rims(). It is no more
/// than the slip and against it, so that a load turns that round at most, and adds no energy.
/// @param contacts   of a pair, in the list, of which the first on a rim counts
/// @param velocity   of b against a there [m/s]
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

/// Whose surfaces: that of the body which is driven, else of the one that turns less.
enum class TurningOf { kSlower, kA, kB };
inline TurningOf turning_of(const Simulation& simulation, BodyId a, BodyId b) {
    const bool of_a = is_driven(simulation, a), of_b = is_driven(simulation, b);
    return of_a == of_b ? TurningOf::kSlower : of_a ? TurningOf::kA : TurningOf::kB;
}
/// How b moves against a [m/s] before gravity, which the load takes back along the normal.
inline Vec4 velocity_before_gravity(const Simulation& simulation, const StepData& step, BodyId a,
                                    BodyId b) {
    const double kicks = simulation.type_of(b).falls - simulation.type_of(a).falls;
    return step.velocity[b] - step.velocity[a] - kicks * step.h * simulation.settings.gravity;
}

/// Whether any contact of the island overlaps by more than is left alone, and some body is held: a
/// position correction then follows the load, with which bodies move, and which is given back
/// afterwards. So it moves bodies without impulses, which changes the angular momentum of those
/// that move against each other: where nothing is held that is kept.
bool is_corrected(const Simulation& simulation, const StepData& step, std::size_t island);

/// What gravity gives an island's bodies in a sub-step from rest [J].
double energy_of_fall(const Simulation& simulation, const StepData& step, std::size_t island);

/// Whether what contacts do not move gives an island more by the warm start than kWarmStartStop
/// times what gravity does: something that has hit it is being stopped.
bool is_stopped(const Simulation& simulation, const StepData& step, std::size_t island);

/// How hard an island's bodies hit each other.
struct Impact {
    double fastest = 0;   ///< speed at which they meet [m/s]; 0: none does
    double returned = 0;  ///< the greatest part of such a speed that restitution gives back
    bool driven = false;  ///< some body moves at a velocity of its own; see is_driven()
};
/// Of one contact, by its place, but for `driven`. Needs the velocities before gravity.
Impact impact_of(const Simulation& simulation, const StepData& step, std::size_t place);

/// Passes points of a run that may be impacts.
class ImpactFilter {
  public:
    /// @param contact   any of the run
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
