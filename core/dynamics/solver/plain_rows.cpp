// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/solver/plain_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/dynamics/constraints/contact_row.hpp"
#include "core/dynamics/constraints/rolling_row.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/solver/solve_island.hpp"

namespace tesserae {

static_assert(IslandRows<PlainRows>);

namespace {

template <bool kTurning>
void apply_impulse(const Simulation& simulation, StepData& step, BodyId id, const Vec4& r,
                   const Vec4& impulse) {
    const TypeProperties& type = simulation.type_of(id);
    if (!type.movable) return;
    step.velocity[id] += type.inverse_mass * impulse;
    if constexpr (kTurning)
        step.angular_velocity[id] += angular_response(simulation, step, id, wedge(r, impulse));
}

template <bool kTurning>
void apply_impulse(const Simulation& simulation, StepData& step, const ContactRow& row,
                   const Vec4& impulse) {
    apply_impulse<kTurning>(simulation, step, row.a, row.r_a, -impulse);
    apply_impulse<kTurning>(simulation, step, row.b, row.r_b, impulse);
}

/// The friction impulse for a relative velocity v: that which ends the slip, if friction allows it.
/// Else the largest that it allows, against the slip: clamping the former would be against what
/// turns into the slip by the bodies' responses, and a box that slides on its corners would push
/// each aside instead of slowing down (by 24 % too little). A step against the slip itself ends
/// where both are parallel.
Vec4 friction_impulse(const ContactRow& row, const Vec4& v) {
    const Vec4 slip = v - row.normal.dot(v) * row.normal;
    const double most = row.friction * row.normal_impulse;
    const Vec4 impulse = row.tangent_impulse - row.tangent_mass * slip;
    if (impulse.squaredNorm() <= most * most) return impulse;
    return clamped_to_ball(row.tangent_impulse - row.slide_mass * slip, most);
}

/// Of a row's impulses in a sweep [N s].
struct RowChange {
    double normal = 0;
    Vec4 tangent = Vec4::Zero();
};

/// The normal first and then friction, so that no contact ends with more of it than its normal
/// impulse allows; what the normal impulse does to the slip is known from the row, so that the
/// bodies' velocities are read and written once.
template <double ContactTargets::*kTarget, bool kTurning, bool kFriction>
RowChange solve_row(const Simulation& simulation, StepData& step, ContactRow& row) {
    const Vec4 v = relative_velocity(step, row.a, row.r_a, row.b, row.r_b, kTurning);
    const double left = row.targets.*kTarget - row.normal.dot(v);
    const double normal = std::max(0.0, row.normal_impulse + row.normal_mass * left);
    const double change = normal - row.normal_impulse;
    // Apart, and friction is 0 too unless the normal impulse ended in an adjoint sweep.
    if (change == 0 && normal == 0 && row.tangent_impulse == Vec4::Zero()) return {};
    row.normal_impulse = normal;
    RowChange changes{change};
    if (kFriction && row.friction > 0) {
        const Vec4 tangent =
            friction_impulse(row, v + change * row.normal_response + row.slip_by_turning);
        changes.tangent = tangent - row.tangent_impulse;
        row.tangent_impulse = tangent;
    }
    apply_impulse<kTurning>(simulation, step, row, change * row.normal + changes.tangent);
    return changes;
}

/// The adjoint of solve_row(): friction first.
template <double ContactTargets::*kTarget, bool kTurning, bool kFriction>
RowChange solve_row_adjoint(const Simulation& simulation, StepData& step, ContactRow& row) {
    const Vec4 v = relative_velocity(step, row.a, row.r_a, row.b, row.r_b, kTurning);
    double left = row.targets.*kTarget - row.normal.dot(v);
    RowChange changes;
    if (kFriction && row.friction > 0) {
        const Vec4 tangent = friction_impulse(row, v + row.slip_by_turning);
        changes.tangent = tangent - row.tangent_impulse;
        row.tangent_impulse = tangent;
        left -= row.normal_response.dot(changes.tangent);
    }
    const double normal = std::max(0.0, row.normal_impulse + row.normal_mass * left);
    changes.normal = normal - row.normal_impulse;
    row.normal_impulse = normal;
    if (changes.normal == 0 && changes.tangent == Vec4::Zero()) return changes;
    apply_impulse<kTurning>(simulation, step, row, changes.normal * row.normal + changes.tangent);
    return changes;
}

/// The larger of the velocities along and across the normal that a change makes up for [m/s].
double velocity_left(const ContactRow& row, const RowChange& change) {
    const double along = change.normal != 0 ? std::abs(change.normal) / row.normal_mass : 0;
    return row.slide_mass > 0 ? std::max(along, change.tangent.norm() / row.slide_mass) : along;
}

}  // namespace

Impact PlainRows::impact(int) const {
    return impact_of_runs(simulation_, step_, step_.islands.runs_in(island_));
}

Effort PlainRows::effort_of(int, const Impact& impact) const {
    const bool is_patch = step_.awaits[island_] == Awaits::kPatch;
    const double part = is_patch ? kLargeImpactResidual : kImpactResidual;
    return effort_of_impact(simulation_.settings, rows().size(), impact, part, along_directions());
}

/// Calls visit(row, contact) for all rows; contact: its place in the list.
template <class Visit>
void PlainRows::for_each_row(const Visit& visit) const {
    ContactRow* row = rows().data();
    for (const std::uint32_t n : step_.islands.runs_in(island_)) {
        const ContactList::Run run = step_.contacts.nth_run(n);
        for (std::size_t contact = run.begin; contact < run.end; ++contact) visit(*row++, contact);
    }
}

void PlainRows::list_bodies() {
    const Islands& islands = step_.islands;
    const std::size_t place = 2 * (islands.first_row[island_] + islands.first_constraint[island_]);
    BodyId* const first = &step_.bodies_of_rows[place];
    BodyId* end = first;
    const auto list = [&](BodyId a, BodyId b) {
        for (const BodyId id : {a, b})
            if (simulation_.is_movable(id)) *end++ = id;
    };
    for (const std::uint32_t n : islands.runs_in(island_)) {
        const ContactList::Run run = step_.contacts.nth_run(n);
        list(run.a, run.b);
    }
    others_.for_all([&](const Constraint& constraint) { list(constraint.a, constraint.b); });
    std::sort(first, end);
    bodies_ = {first, std::unique(first, end)};
    motions_ = {&step_.motions_of_rows[place], bodies_.size()};
}

void PlainRows::keep_motions() {
    if (bodies_.empty()) list_bodies();
    for (std::size_t i = 0; i < bodies_.size(); ++i) motions_[i] = motion_of(step_, bodies_[i]);
}

void PlainRows::restore_motions() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        step_.velocity[bodies_[i]] = motions_[i].velocity;
        step_.angular_velocity[bodies_[i]] = motions_[i].angular_velocity;
    }
}

void PlainRows::make_rows() {
    const bool made = step_.has_rows[island_];
    const Parting parting = parting_of(step_, island_);
    ContactRow* row = rows().data();
    const auto start = [&](std::size_t place, const Parting& of_pair) {
        const Contact contact = step_.contacts[place];
        if (!made) *row = make_row(simulation_, step_, contact);
        const ContactImpulse last =
            cause_ == Cause::kLoad ? step_.impulses[place] : ContactImpulse{};
        start_row(simulation_, step_, contact, place, last, cause_, of_pair, *row);
        if (!simulation_.needs.rolling) return;
        RollingRow& rolling = rolling_row_of(*row);
        if (!made) rolling = make_rolling_row(simulation_, step_, *row);
        start_rolling_row(*row, cause_ == Cause::kLoad ? step_.angular_impulses[place] : Bivector{},
                          rolling);
    };
    for (const std::uint32_t n : step_.islands.runs_in(island_)) {
        const ContactList::Run run = step_.contacts.nth_run(n);
        const Parting of_pair = parting.at(step_, {run.begin, run.end});
        for (std::size_t place = run.begin; place < run.end; ++place, ++row) start(place, of_pair);
    }
    step_.has_rows[island_] = 1;
}

/// Islands are solved one after the other on a thread, so that one block serves all of them.
void PlainRows::begin_block() {
    if (block_ || !step_.islands.direct[island_]) return;
    thread_local JointBlock block;
    const bool follows_impact = cause_ == Cause::kLoad && step_.was_hit[island_];
    if (block.begin(simulation_, step_, step_.islands.constraints_in(island_), cause_,
                    follows_impact))
        block_ = &block;
    // Geometric stiffness takes part in all that the impulses change, from the first on.
    others_.for_all([&](Constraint& c) { c.starts_anew = block_ && block_->has_stiffness(); });
}

void PlainRows::start(Cause cause, Members) {
    cause_ = cause;
    if (bodies_.empty())
        keep_motions();
    else
        restore_motions();
    make_rows();
    begin_block();
    others_.start(cause);
    if (cause == Cause::kLoad) apply_part_of_contacts(1);
}

double PlainRows::sweep_others(Sweep sweep) {
    const double of_block = block_ ? block_->sweep(simulation_, step_, sweep.pass) : 0;
    return std::max(of_block, others_.sweep(sweep, cause_));
}

/// @return the largest velocity_left() if it is measured, else 0
template <double ContactTargets::*kTarget, bool kTurning, bool kFriction, bool kRolling>
double PlainRows::sweep_rows(Sweep sweep) {
    double residual = 0;
    const std::span<ContactRow> all = rows();
    for (std::size_t i = 0; i < all.size(); ++i) {
        ContactRow& row = all[sweep.backward ? all.size() - 1 - i : i];
        const RowChange change =
            sweep.adjoint ? solve_row_adjoint<kTarget, kTurning, kFriction>(simulation_, step_, row)
                          : solve_row<kTarget, kTurning, kFriction>(simulation_, step_, row);
        if constexpr (kRolling) solve_rolling_row(simulation_, step_, row, rolling_row_of(row));
        if (sweep.measured) residual = std::max(residual, velocity_left(row, change));
    }
    return residual;
}

template <bool kTurning, bool kRolling>
double PlainRows::sweep_contacts(Sweep sweep) {
    switch (sweep.pass) {
        case Pass::kSolve:
            return sweep_rows<&ContactTargets::first, kTurning, true, kRolling>(sweep);
        case Pass::kFrictionless:
            return sweep_rows<&ContactTargets::first, kTurning, false, false>(sweep);
        case Pass::kRestitution:
            return sweep_rows<&ContactTargets::second, kTurning, true, kRolling>(sweep);
        default:
            return sweep_rows<&ContactTargets::second, kTurning, false, false>(sweep);
    }
}

PerMember<double> PlainRows::sweep(Sweep one, Members) {
    const Needs& needs = simulation_.needs;
    const double before = one.backward ? sweep_others(one) : 0;
    const double of_contacts = needs.rolling   ? sweep_contacts<true, true>(one)
                               : needs.turning ? sweep_contacts<true, false>(one)
                                               : sweep_contacts<false, false>(one);
    PerMember<double> residual;
    residual[0] = std::max({before, of_contacts, one.backward ? 0 : sweep_others(one)});
    return residual;
}

PerMember<PassEnd> PlainRows::iterate(Pass pass, const PerMember<Effort>& efforts, Members some) {
    return tesserae::iterate(pass, efforts, some,
                             [&](Sweep one, Members swept) { return sweep(one, swept); });
}

void PlainRows::apply_impulse(const ContactRow& row, const Vec4& impulse) {
    if (simulation_.needs.turning)
        tesserae::apply_impulse<true>(simulation_, step_, row, impulse);
    else
        tesserae::apply_impulse<false>(simulation_, step_, row, impulse);
}

/// Of the rows' impulses.
void PlainRows::apply_part_of_contacts(double part) {
    for (const ContactRow& row : rows()) {
        apply_impulse(row, part * (row.normal_impulse * row.normal + row.tangent_impulse));
        if (simulation_.needs.rolling)
            apply_angular_impulse(simulation_, step_, row.a, row.b,
                                  part * angular_impulse_of(row, rolling_row_of(row)));
    }
}

/// What the rows' impulses times their velocities are, less those times the targets.
double PlainRows::work() const {
    double sum = others_.work();
    for (const ContactRow& row : rows()) {
        const Vec4 v =
            relative_velocity(step_, row.a, row.r_a, row.b, row.r_b, simulation_.needs.turning);
        sum += row.normal_impulse * (row.normal.dot(v) - row.targets.first);
        sum += row.tangent_impulse.dot(v + row.slip_by_turning);
        if (simulation_.needs.rolling)
            sum += dot(angular_impulse_of(row, rolling_row_of(row)),
                       step_.angular_velocity[row.b] - step_.angular_velocity[row.a]);
    }
    return sum;
}

/// Between what they are and what they were before the rows' impulses.
void PlainRows::swap_motions() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        std::swap(step_.velocity[bodies_[i]], motions_[i].velocity);
        std::swap(step_.angular_velocity[bodies_[i]], motions_[i].angular_velocity);
    }
}

/// What impulses have changed of the velocities that they work on is twice their energy.
LoadWork PlainRows::load(int) {
    const double after = work();
    swap_motions();
    const double before = work();
    swap_motions();
    return {before, after - before + others_.twice_give()};
}

void PlainRows::leave_part(const PerMember<double>& parts, Members) {
    const double part = parts[0];
    apply_part_of_contacts(part - 1);
    others_.apply_part(part - 1);
    others_.leave_part(part);
    for (ContactRow& row : rows()) {
        row.normal_impulse *= part;
        row.tangent_impulse *= part;
        if (!simulation_.needs.rolling) continue;
        RollingRow& rolling = rolling_row_of(row);
        rolling.rolling.impulse *= part;
        rolling.twisting.impulse *= part;
    }
}

std::array<double, 2> PlainRows::energies(int) const {
    std::array<double, 2> sums = {};
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        sums[0] += twice_kinetic_energy(simulation_, step_, bodies_[i], motions_[i]);
        sums[1] +=
            twice_kinetic_energy(simulation_, step_, bodies_[i], motion_of(step_, bodies_[i]));
    }
    return sums;
}

void PlainRows::keep_impact_motion(Members) {
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        step_.impact_motion[bodies_[i]] = {motions_[i], motion_of(step_, bodies_[i])};
}

RestitutionSums PlainRows::restitution(int) const {
    return restitution_of(simulation_, step_, bodies_);
}

void PlainRows::leave_part_of_restitution(int, double part) {
    tesserae::leave_part_of_restitution(simulation_, step_, bodies_, part);
}

void PlainRows::keep(Members) {
    if (block_) block_->end(simulation_, step_);
    others_.keep(cause_);
    for_each_row([&](const ContactRow& row, std::size_t contact) {
        if (cause_ == Cause::kImpact) {
            step_.hit[contact] = row.normal_impulse;
            return;
        }
        step_.impulses[contact] = contact_impulse(row.normal_impulse, row.tangent_impulse);
        if (simulation_.needs.rolling)
            step_.angular_impulses[contact] = angular_impulse_of(row, rolling_row_of(row));
    });
}

void PlainRows::begin_correction(Members) { keep_motions(); }

void PlainRows::end_correction(Members) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const BodyMotion corrected = motion_of(step_, bodies_[i]) - motions_[i];
        step_.velocity[bodies_[i]] = motions_[i].velocity;
        step_.angular_velocity[bodies_[i]] = motions_[i].angular_velocity;
        motions_[i] = corrected;
    }
}

void PlainRows::apply_correction(Members) {
    list_bodies();
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        displace(simulation_, step_, bodies_[i], motions_[i]);
}

}  // namespace tesserae
