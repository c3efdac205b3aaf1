// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/contact_targets.hpp"

#include <algorithm>
#include <cmath>

#include "core/dynamics/constants.hpp"

namespace tesserae {
namespace {

/// Approach::slowest
double slowest_impact(const StepData& step, const TypeProperties& a, const TypeProperties& b) {
    const double kick = std::max(std::abs(a.gravity_scale), std::abs(b.gravity_scale)) * step.kick;
    const double slowest = kRestitutionKicks * kick;
    if (std::max(a.restitution, b.restitution) > 0) return slowest;
    return std::max(slowest, kStill * (std::min(a.slop, b.slop) / kSlop));
}

Approach approach_of(const Simulation& simulation, const StepData& step, const Contact& contact) {
    const TypeProperties& a = simulation.type_of(contact.a);
    const TypeProperties& b = simulation.type_of(contact.b);
    const Vec4& gravity = simulation.settings.gravity;
    const double half_size = std::min(a.slop, b.slop) / kSlop;
    Approach approach;
    approach.e = std::max(a.restitution, b.restitution);
    approach.slowest = slowest_impact(step, a, b);
    if (step.kick > 0)  // in the rounds of LostTime gravity has acted already
        approach.g = (a.gravity_scale - b.gravity_scale) * contact.normal.dot(gravity);
    approach.through = 0.5 * half_size * approach.e * approach.e;  // as is the energy at stake
    return approach;
}

/// The velocity along the normal that leaves the surface at e times the speed v with which the
/// bodies meet there, v^2 = v0^2 + 2 g s0, when they accelerate towards each other at g, approached
/// at v0 with the gap s0 at the start of the sub-step, and are s apart in its middle. The velocity
/// w and the gap s + h w/2 at the end of the sub-step then have the energy of that rebound:
/// w^2 + 2 g (s + h w/2) = e^2 v^2.
double rebound_velocity(double e, double v0, double g, double s, double h) {
    const double s0 = s + 0.5 * h * v0;
    const double at_surface = std::max(0.0, v0 * v0 + 2 * g * s0);
    const double half = 0.5 * g * h;
    return std::sqrt(std::max(0.0, half * half + e * e * at_surface - 2 * g * s)) - half;
}

/// Overlap that is left alone [m].
double slop_of(const Simulation& simulation, BodyId a, BodyId b) {
    return std::min(simulation.type_of(a).slop, simulation.type_of(b).slop);
}

/// Bodies that bounce and do not hit each other by themselves: stopping them at each other's
/// surface if another impact drives them there would lose that energy. They may overlap and bounce
/// in the next sub-step, so that impacts go through a row of bodies one after the other.
ContactTargets targets_of_driven(const Approach& approach, double s, double h) {
    const double aim = -(s + approach.through) / h;
    return {aim, aim};
}

/// @param v0     at which the points meet
/// @param rise   rise_of() the contact; by so much less the surfaces meet there
ContactTargets targets_of_impact(const Approach& approach, double s, double h, double v0,
                                 double rise) {
    const double g = approach.g;
    const double touching = s > 0 ? -s / h : 0;
    if (approach.e == 0) return {touching, touching};
    if (s > h * (v0 + rise + h * g) || !(v0 - rise > approach.slowest))
        return s > -approach.through ? targets_of_driven(approach, s, h)
                                     : ContactTargets{touching, touching};
    return {0, std::max(0.0, rebound_velocity(approach.e, v0 - rise, g, s, h) + h * g)};
}

/// The aim for the points that brings the surfaces to where it says of them. A rim that rolls on
/// meets the ground at the rise and leaves it at that in every sub-step, and on average stays on
/// it; no point leaves faster than it met, so that none of this adds energy.
double raised(double aim, double rise, double most) {
    return aim > 0 ? aim + std::min(rise, most) : std::max(aim, std::min(aim + rise, most));
}

}  // namespace

double resting_gap(const Simulation& simulation, BodyId a, BodyId b) {
    return kRestingGap * slop_of(simulation, a, b);
}

Parting Parting::at(const StepData& step, Range contacts) const {
    Parting of = *this;
    double load = 0;
    if (corrected)
        for (std::size_t i = contacts.begin; i < contacts.end; ++i) load += step.impulses[i].normal;
    if (load > 0) of.part = std::max(0.0, 1 - load / (kPartedWeight * weight));
    return of;
}

Parting parting_of(const StepData& step, std::size_t island) {
    return {step.corrected[island] != 0, step.islands.falling_mass[island] * step.kick};
}

PairTargets::PairTargets(const Simulation& simulation, const StepData& step, const Contact& contact,
                         Cause cause, const Parting& parting)
    : cause_(cause),
      bounces_(simulation.needs.restitution),
      needs_approach_(cause == Cause::kImpact || bounces_ || simulation.needs.rims),
      h_(step.h),
      slop_(slop_of(simulation, contact.a, contact.b)),
      // Acts on the second half of the sub-step only, so that it has to be twice as large.
      fastest_(kFastestCorrection / kSlop * slop_ + step.kick),
      bias_(parting.corrected
                ? std::min(fastest_, parting.part * (kBiasPart / h_ * kCorrectedBias * slop_))
                : fastest_) {
    if (needs_approach_) approach_ = approach_of(simulation, step, contact);
}

ContactTargets PairTargets::at(double separation, double velocity, double rise) const {
    ContactTargets targets = of_level(separation, velocity, rise);
    if (rise == 0) return targets;
    const double met = -velocity - (cause_ == Cause::kLoad ? h_ * approach_.g : 0);
    const double most = std::max(0.0, met);
    return {raised(targets.first, rise, most), raised(targets.second, rise, most)};
}

/// But for the rise of the aim. Bodies that bounce and rest on each other, which rounding puts
/// apart, are held as any others are.
ContactTargets PairTargets::of_level(double s, double velocity, double rise) const {
    if (cause_ == Cause::kImpact) return targets_of_impact(approach_, s, h_, -velocity, rise);
    if (bounces_ && approach_.e > 0) {
        const double v1 = -velocity, v0 = v1 - h_ * approach_.g;
        const bool apart = s > kRestingGap * slop_ && s > h_ * (v1 + rise);
        if (s > -approach_.through && (apart || v0 - rise > approach_.slowest))
            return targets_of_driven(approach_, s, h_);
    }
    return of_overlap(s);
}

/// What keeps bodies apart or takes them apart.
ContactTargets PairTargets::of_overlap(double s) const {
    if (s > -slop_) {
        const double aim = s > kRestingGap * slop_ ? -s / h_ : 0;
        return {aim, aim};
    }
    const double depth = -(s + slop_);
    return {std::min(bias_, kBiasPart / h_ * depth),
            std::min(fastest_, 2 * kBiasPart / h_ * depth)};
}

Vec4 slip_by_turning(const Simulation& simulation, const StepData& step, const Contact& contact,
                     Cause cause) {
    if (cause == Cause::kImpact || !simulation.needs.turning) return Vec4::Zero();
    const Bivector &of_a = step.angular_velocity[contact.a],
                   &of_b = step.angular_velocity[contact.b];
    const TurningOf turning = turning_of(simulation, contact.a, contact.b);
    const bool is_a = turning == TurningOf::kSlower ? dot(of_a, of_a) <= dot(of_b, of_b)
                                                    : turning == TurningOf::kA;
    const Bivector& w = is_a ? of_a : of_b;
    if (w == Bivector{}) return Vec4::Zero();
    const Vec4 u = velocity_before_gravity(simulation, step, contact.a, contact.b);
    const Vec4& n = contact.normal;
    const Vec4 slip = -0.5 * step.h * velocity_at(w, u);
    return slip - n.dot(slip) * n;
}

bool is_corrected(const Simulation& simulation, const StepData& step, std::size_t island) {
    if (!step.islands.held[island]) return false;
    for (const std::uint32_t n : step.islands.runs_in(island)) {
        const ContactList::Run run = step.contacts.nth_run(n);
        const double deep = -slop_of(simulation, run.a, run.b);
        for (std::size_t i = run.begin; i < run.end; ++i)
            if (step.contacts.separation(i) < deep) return true;
    }
    return false;
}

double energy_of_fall(const Simulation& simulation, const StepData& step, std::size_t island) {
    const Vec4 kick = step.h * simulation.settings.gravity;
    return 0.5 * step.islands.falling_mass[island] * kick.squaredNorm();
}

ImpactFilter::ImpactFilter(const Simulation& simulation, const StepData& step, const Contact& c)
    : centre_(step.position[c.a]),
      slowest_(slowest_impact(step, simulation.type_of(c.a), simulation.type_of(c.b))) {
    // At r from a's centre b's velocity against a is v + w.r, and n.(w.r) = -(w.n).r.
    Vec4 v = step.velocity[c.b] - step.velocity[c.a];
    if (simulation.needs.turning) {
        const Bivector& w_b = step.angular_velocity[c.b];
        v += velocity_at(w_b, centre_ - step.position[c.b]);
        turning_ = velocity_at(w_b - step.angular_velocity[c.a], c.normal);
    }
    approach_ = -c.normal.dot(v);
}

Impact impact_of(const Simulation& simulation, const StepData& step, std::size_t place) {
    const Contact contact = step.contacts[place];
    const double rise = rise_of(step, place);
    const Vec4 r_a = contact.point - step.position[contact.a];
    const Vec4 r_b = contact.point - step.position[contact.b];
    const double v0 = -contact.normal.dot(
        relative_velocity(step, contact.a, r_a, contact.b, r_b, simulation.needs.turning));
    if (!(v0 > 0)) return {};
    const Approach approach = approach_of(simulation, step, contact);
    const bool meets = contact.separation <= step.h * (v0 + rise + step.h * approach.g);
    if (!meets || !(v0 - rise > approach.slowest)) return {};
    Impact impact;
    impact.fastest = v0;
    if (approach.e == 0) return impact;
    // Of the points: a rise does not make them slower than they met.
    const double left = targets_of_impact(approach, contact.separation, step.h, v0, rise).second;
    impact.returned = std::max(0.0, raised(left, rise, v0)) / v0;
    return impact;
}

}  // namespace tesserae
