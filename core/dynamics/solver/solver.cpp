#include "core/dynamics/solver/solver.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/dynamics/solver/blow.hpp"
#include "core/dynamics/solver/coloured_solver.hpp"
#include "core/dynamics/solver/contact_row.hpp"
#include "core/dynamics/solver/rolling_row.hpp"
#include "core/dynamics/solver/static_loads.hpp"

namespace tesserae {
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
    if (change == 0 && normal == 0) return {};  // apart, and friction is 0 too
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

/// The larger of the velocities along and across the normal that a change makes up for [m/s].
double velocity_left(const ContactRow& row, const RowChange& change) {
    const double along = change.normal != 0 ? std::abs(change.normal) / row.normal_mass : 0;
    return row.slide_mass > 0 ? std::max(along, change.tangent.norm() / row.slide_mass) : along;
}

/// Where there is rolling friction.
RollingRow& rolling_row_of(StepData& step, const ContactRow& row) {
    return step.rolling_rows[static_cast<std::size_t>(&row - step.rows.data())];
}

/// @return the largest velocity_left() if it is measured, else 0
template <double ContactTargets::*kTarget, bool kTurning, bool kFriction, bool kRolling>
double sweep_rows(const Simulation& simulation, StepData& step, std::span<ContactRow> rows,
                  Sweep sweep) {
    double residual = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        ContactRow& row = rows[sweep.backward ? rows.size() - 1 - i : i];
        const RowChange change = solve_row<kTarget, kTurning, kFriction>(simulation, step, row);
        if constexpr (kRolling) solve_rolling_row(simulation, step, row, rolling_row_of(step, row));
        if (sweep.measured) residual = std::max(residual, velocity_left(row, change));
    }
    return residual;
}

template <bool kTurning, bool kRolling>
double run_pass(const Simulation& simulation, StepData& step, std::span<ContactRow> rows, Pass pass,
                const Effort& effort) {
    return iterate(pass, effort, [&](Sweep sweep) {
        switch (pass) {
            case Pass::kSolve:
                return sweep_rows<&ContactTargets::first, kTurning, true, kRolling>(
                    simulation, step, rows, sweep);
            case Pass::kRestitution:
                return sweep_rows<&ContactTargets::second, kTurning, true, kRolling>(
                    simulation, step, rows, sweep);
            default:
                return sweep_rows<&ContactTargets::second, kTurning, false, false>(simulation, step,
                                                                                   rows, sweep);
        }
    });
}

double run_pass(const Simulation& simulation, StepData& step, std::span<ContactRow> rows, Pass pass,
                const Effort& effort) {
    const Needs& needs = simulation.needs;
    if (needs.rolling) return run_pass<true, true>(simulation, step, rows, pass, effort);
    return needs.turning ? run_pass<true, false>(simulation, step, rows, pass, effort)
                         : run_pass<false, false>(simulation, step, rows, pass, effort);
}

/// Of the rows' impulses.
void apply_part(const Simulation& simulation, StepData& step, std::span<const ContactRow> rows,
                double part) {
    for (const ContactRow& row : rows) {
        const Vec4 impulse = part * (row.normal_impulse * row.normal + row.tangent_impulse);
        if (simulation.needs.turning)
            apply_impulse<true>(simulation, step, row, impulse);
        else
            apply_impulse<false>(simulation, step, row, impulse);
        if (simulation.needs.rolling)
            apply_angular_impulse(simulation, step, row.a, row.b,
                                  part * angular_impulse_of(row, rolling_row_of(step, row)));
    }
}

std::span<ContactRow> rows_of(StepData& step, std::size_t island) {
    return {&step.rows[step.islands.first_row[island]], step.islands.contacts[island]};
}

/// Calls visit(row, contact) for all rows of an island; contact: its place in the list.
template <class Visit>
void for_each_row(StepData& step, std::size_t island, const Visit& visit) {
    ContactRow* row = rows_of(step, island).data();
    for (const std::uint32_t n : step.islands.runs_in(island)) {
        const ContactList::Run run = step.contacts.nth_run(n);
        for (std::size_t contact = run.begin; contact < run.end; ++contact) visit(*row++, contact);
    }
}

void start_rows(const Simulation& simulation, StepData& step, std::size_t island, Cause cause) {
    const bool made = step.has_rows[island];
    const Parting parting = parting_of(step, island);
    const auto start = [&](std::size_t place, const Parting& of_pair, ContactRow& row) {
        const Contact contact = step.contacts[place];
        if (!made) row = make_row(simulation, step, contact);
        const ContactImpulse last = cause == Cause::kLoad ? step.impulses[place] : ContactImpulse{};
        start_row(simulation, step, contact, place, last, cause, of_pair, row);
        if (!simulation.needs.rolling) return;
        RollingRow& rolling = rolling_row_of(step, row);
        if (!made) rolling = make_rolling_row(simulation, step, row);
        start_rolling_row(row, cause == Cause::kLoad ? step.angular_impulses[place] : Bivector{},
                          rolling);
    };
    ContactRow* row = rows_of(step, island).data();
    for (const std::uint32_t n : step.islands.runs_in(island)) {
        const ContactList::Run run = step.contacts.nth_run(n);
        const Parting of_pair = parting.at(step, {run.begin, run.end});
        for (std::size_t place = run.begin; place < run.end; ++place) start(place, of_pair, *row++);
    }
    step.has_rows[island] = 1;
}

/// The movable bodies of an island that is not coloured, each once.
std::span<const BodyId> bodies_of(const Simulation& simulation, StepData& step,
                                  std::size_t island) {
    BodyId* const first = step.bodies_of_rows.data() + 2 * step.islands.first_row[island];
    BodyId* end = first;
    for (const ContactRow& row : rows_of(step, island))
        for (const BodyId id : {row.a, row.b})
            if (simulation.type_of(id).movable) *end++ = id;
    std::sort(first, end);
    return {first, std::unique(first, end)};
}

/// What the rows' impulses times their velocities are, less those times the load's targets.
double work_of(const Simulation& simulation, StepData& step, std::span<const ContactRow> rows) {
    double sum = 0;
    for (const ContactRow& row : rows) {
        const Vec4 v =
            relative_velocity(step, row.a, row.r_a, row.b, row.r_b, simulation.needs.turning);
        sum += row.normal_impulse * (row.normal.dot(v) - row.targets.first);
        sum += row.tangent_impulse.dot(v + row.slip_by_turning);
        if (simulation.needs.rolling)
            sum += dot(angular_impulse_of(row, rolling_row_of(step, row)),
                       step.angular_velocity[row.b] - step.angular_velocity[row.a]);
    }
    return sum;
}

/// Of the rows' impulses, which have been applied.
void leave_part(const Simulation& simulation, StepData& step, std::span<ContactRow> rows,
                double part) {
    apply_part(simulation, step, rows, part - 1);
    for (ContactRow& row : rows) {
        row.normal_impulse *= part;
        row.tangent_impulse *= part;
        if (!simulation.needs.rolling) continue;
        RollingRow& rolling = rolling_row_of(step, row);
        rolling.rolling.impulse *= part;
        rolling.twisting.impulse *= part;
    }
}

/// The impulses that the load starts from; see kRecalledWeight.
void apply_recalled(const Simulation& simulation, StepData& step, std::size_t island) {
    const std::span<ContactRow> rows = rows_of(step, island);
    const double before = work_of(simulation, step, rows);
    apply_part(simulation, step, rows, 1);
    const double after = work_of(simulation, step, rows);
    const LoadWork load = {before, after - before};
    const double weight = energy_of_fall(simulation, step, island);
    if (0.5 * load.energy > LoadWork::least_of_stop(weight) &&
        load.is_too_much(weight, is_stopped(simulation, step, island)))
        leave_part(simulation, step, rows, load.best_part());
}

void keep_hits(StepData& step, std::size_t island) {
    for_each_row(step, island, [&](const ContactRow& row, std::size_t contact) {
        step.hit[contact] = row.normal_impulse > 0;
    });
}

void keep_impulses(const Simulation& simulation, StepData& step, std::size_t island) {
    for_each_row(step, island, [&](const ContactRow& row, std::size_t contact) {
        step.impulses[contact] = contact_impulse(row.normal_impulse, row.tangent_impulse);
        if (simulation.needs.rolling)
            step.angular_impulses[contact] = angular_impulse_of(row, rolling_row_of(step, row));
    });
}

/// Until this thread keeps others.
std::span<const BodyMotion> keep_motions(const StepData& step, std::span<const BodyId> bodies) {
    thread_local std::vector<BodyMotion> motions;
    motions.clear();
    for (const BodyId id : bodies) motions.push_back(motion_of(step, id));
    return motions;
}
void restore_turning(StepData& step, std::span<const BodyId> bodies,
                     std::span<const BodyMotion> motions) {
    for (std::size_t i = 0; i < bodies.size(); ++i)
        step.angular_velocity[bodies[i]] = motions[i].angular_velocity;
}

/// From the rows' impulses to those of the load.
void take_push_back(const Simulation& simulation, StepData& step, std::size_t island) {
    const bool straight = step.pushed[island] == Push::kStraight;
    std::span<const BodyId> bodies;
    std::span<const BodyMotion> before;
    if (straight) {
        bodies = bodies_of(simulation, step, island);
        before = keep_motions(step, bodies);
    }
    for_each_row(step, island, [&](const ContactRow& row, std::size_t contact) {
        const ContactImpulse& load = step.impulses[contact];
        const Vec4 back = (load.normal - row.normal_impulse) * row.normal +
                          (load.tangent() - row.tangent_impulse);
        if (simulation.needs.turning)
            apply_impulse<true>(simulation, step, row, back);
        else
            apply_impulse<false>(simulation, step, row, back);
        if (simulation.needs.rolling)
            apply_angular_impulse(simulation, step, row.a, row.b,
                                  step.angular_impulses[contact] -
                                      angular_impulse_of(row, rolling_row_of(step, row)));
    });
    if (straight) restore_turning(step, bodies, before);
}

/// The rows without their impulses and without friction.
void restart_without_friction(const Simulation& simulation, StepData& step, std::size_t island) {
    for (ContactRow& row : rows_of(step, island)) {
        row.normal_impulse = row.friction = 0;
        row.tangent_impulse.setZero();
        if (!simulation.needs.rolling) continue;
        RollingRow& rolling = rolling_row_of(step, row);
        rolling.arm = 0;
        rolling.rolling.impulse.setZero(), rolling.twisting.impulse.setZero();
    }
    step.has_rows[island] = 0;  // they are no longer those of the contacts
}

/// The first part of a blow; see can_jam().
void compress(const Simulation& simulation, StepData& step, std::size_t island, const Blow& blow,
              const Effort& effort) {
    const std::span<ContactRow> rows = rows_of(step, island);
    if (!can_jam(simulation, blow)) {
        run_pass(simulation, step, rows, Pass::kSolve, effort);
        return;
    }
    const std::span<const BodyId> bodies = bodies_of(simulation, step, island);
    const auto energy = [&] {
        double sum = 0;
        for (const BodyId id : bodies)
            sum += twice_kinetic_energy(simulation, step, id, motion_of(step, id));
        return sum;
    };
    // Not won back from the impulses: what jams may leave the finite range.
    const std::span<const BodyMotion> before = keep_motions(step, bodies);
    const double energy_before = energy();
    run_pass(simulation, step, rows, Pass::kSolve, effort);
    if (!has_jammed(energy_before, energy())) return;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        step.velocity[bodies[i]] = before[i].velocity;
        step.angular_velocity[bodies[i]] = before[i].angular_velocity;
    }
    restart_without_friction(simulation, step, island);
    run_pass(simulation, step, rows, Pass::kSolve, effort);
}

/// After the load; nothing is turned where turns_push() says so of any body.
void push(const Simulation& simulation, StepData& step, std::size_t island) {
    const std::span<ContactRow> rows = rows_of(step, island);
    const std::span<const BodyId> bodies = bodies_of(simulation, step, island);
    const std::span<const BodyMotion> before = keep_motions(step, bodies);
    run_pass(simulation, step, rows, Pass::kPush, effort_of_push(simulation, rows.size()));
    bool turns = false;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Bivector& turning = step.angular_velocity[bodies[i]];
        turns |=
            turns_push(simulation, step, bodies[i], turning, turning - before[i].angular_velocity);
    }
    if (!turns) return;
    restore_turning(step, bodies, before);
    step.pushed[island] = Push::kStraight;
}

}  // namespace

void solve_blow(const Simulation& simulation, StepData& step, std::size_t island) {
    if (step.awaits[island] == Awaits::kNothing) return;
    if (step.islands.is_coloured(island))
        return solve_coloured_blow(simulation, step, island, OneThread{});
    const Blow blow = blow_of_runs(simulation, step, step.islands.runs_in(island));
    if (blow.fastest == 0) return;
    step.was_hit[island] = 1;
    start_rows(simulation, step, island, Cause::kBlow);
    const std::span<ContactRow> rows = rows_of(step, island);
    const Effort effort = step.awaits[island] == Awaits::kPatch
                              ? effort_of_patch(simulation, rows.size(), blow.fastest)
                              : effort_of_blow(simulation, rows.size(), blow.fastest);
    if (blow.returned == 0) {
        compress(simulation, step, island, blow, effort);
        return keep_hits(step, island);
    }
    const std::span<const BodyId> bodies = bodies_of(simulation, step, island);
    for (const BodyId id : bodies) step.blow_motion[id].before = motion_of(step, id);
    compress(simulation, step, island, blow, effort);
    for (const BodyId id : bodies) step.blow_motion[id].compressed = motion_of(step, id);
    run_pass(simulation, step, rows, Pass::kRestitution, effort);
    const double part = part_of_restitution(restitution_of(simulation, step, bodies), blow);
    leave_part_of_restitution(simulation, step, bodies, part);
    keep_hits(step, island);
}

void solve_island(const Simulation& simulation, StepData& step, std::size_t island) {
    if (step.islands.is_coloured(island))
        return solve_coloured_island(simulation, step, island, OneThread{});
    hold_still(simulation, step, island);
    if (is_pushed(simulation, step, island)) step.pushed[island] = Push::kAll;
    start_rows(simulation, step, island, Cause::kLoad);
    const std::span<ContactRow> rows = rows_of(step, island);
    apply_recalled(simulation, step, island);
    step.residual[island] =
        run_pass(simulation, step, rows, Pass::kSolve, effort_of_load(simulation, step, island));
    keep_impulses(simulation, step, island);
    if (step.pushed[island] != Push::kNone) push(simulation, step, island);
}

void drop_correction(const Simulation& simulation, StepData& step, std::size_t island) {
    if (step.pushed[island] == Push::kNone) return;
    if (step.islands.is_coloured(island))
        return drop_coloured_correction(simulation, step, island, OneThread{});
    take_push_back(simulation, step, island);
}

}  // namespace tesserae
