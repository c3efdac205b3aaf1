// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <concepts>

#include "core/dynamics/solver/impact.hpp"
#include "core/dynamics/solver/static_loads.hpp"
#include "core/dynamics/solver/sweep.hpp"

// How islands are solved. This one text serves both kinds of rows: PlainRows, one by one in
// double, and ColouredRows, eight or sixteen at a time in float. The rows may be those of several
// islands, which are solved side by side: `some` are those of which something is done, and nothing
// that happens to one depends on the others.
namespace tesserae {

/// The rows of one island or of several, with the functions that the solver needs.
template <class Rows>
concept IslandRows = requires(Rows& rows, Cause cause, Pass pass, const PerMember<Effort>& efforts,
                              const PerMember<double>& parts, double part, const Impact& impact,
                              Members some, int member) {
    rows.simulation();
    rows.step();
    // Whether a load that gains energy is dropped. One of few rows is kept: it gains only where
    // there are two or three sweeps.
    { Rows::kDropsGains } -> std::convertible_to<bool>;
    // Whether all members go along conjugate directions, for which rows have
    // iterate_along_directions(pass, efforts, some, instead). Where gains are dropped, these also
    // limit warm starts and drop gains.
    { rows.along_directions() } -> std::same_as<bool>;
    { rows.members() } -> std::same_as<Members>;
    rows.island(member);
    // Returns the largest numbers of the island's contacts, and how long an impact is swept.
    { rows.impact(member) } -> std::same_as<Impact>;
    { rows.effort_of(member, impact) } -> std::same_as<Effort>;
    // Makes the rows and applies the impulses that they start from. The bodies first get back
    // the motion that they had before the first call, which is for all members.
    rows.start(cause, some);
    { rows.iterate(pass, efforts, some) } -> std::same_as<PerMember<PassEnd>>;
    // Returns what the impulses have done since start(), see LoadWork. load() takes longer.
    { rows.energy(member) } -> std::same_as<double>;
    { rows.load(member) } -> std::same_as<LoadWork>;
    // Multiplies the impulses and what they have changed by a part.
    rows.leave_part(parts, some);
    // Returns an energy, or a multiple of it, before the impulses and after them.
    { rows.energies(member) } -> std::same_as<std::array<double, 2>>;
    // Writes the bodies' motion before the impact and after the compression to
    // step.impact_motion.
    rows.keep_impact_motion(some);
    // Gives the bodies the velocities that the impulses have led to.
    rows.add_changes(some);
    { rows.restitution(member) } -> std::same_as<RestitutionSums>;
    rows.leave_part_of_restitution(member, part);
    // Writes step.impulses of the contacts, or step.hit after an impact.
    rows.keep(some);
    // Are called before and after the sweeps of a position correction, and to move the bodies by
    // it once they have moved by their velocities.
    rows.begin_correction(some);
    rows.end_correction(some);
    rows.apply_correction(some);
};

/// Notes how many sweeps a pass over some islands has taken, for the step's report.
template <IslandRows Rows>
PerMember<PassEnd> noted(const Rows& rows, const PerMember<PassEnd>& ends, Members some) {
    for (const int member : some) {
        int& most = rows.step().sweeps[rows.island(member)];
        most = std::max(most, ends[member].sweeps);
    }
    return ends;
}
/// Solves a pass along conjugate directions, or by one sweep after the other.
/// @param instead   is called for islands whose directions end with a gain of energy, and replaces
///                  their result
template <IslandRows Rows, class Instead>
PerMember<PassEnd> solve_pass(Rows& rows, Pass pass, const PerMember<Effort>& efforts, Members some,
                              const Instead& instead) {
    return noted(rows,
                 rows.along_directions()
                     ? rows.iterate_along_directions(pass, efforts, some, instead)
                     : rows.iterate(pass, efforts, some),
                 some);
}

/// The impacts of islands, and how each is solved.
struct ImpactPlan {
    PerMember<Impact> impact;
    PerMember<Effort> efforts;
    Members hit;  ///< islands that have an impact
};
template <IslandRows Rows>
ImpactPlan plan_impacts(const Rows& rows) {
    ImpactPlan plan;
    StepData& step = rows.step();
    plan.hit = rows.members().where([&](int member) {
        if (step.awaits[rows.island(member)] == Awaits::kNothing) return false;
        plan.impact[member] = rows.impact(member);
        return plan.impact[member].fastest > 0;
    });
    for (const int member : plan.hit) {
        step.was_hit[rows.island(member)] = 1;
        plan.efforts[member] = rows.effort_of(member, plan.impact[member]);
    }
    return plan;
}

/// Does the compression of impacts, once they are started.
template <IslandRows Rows>
void compress(Rows& rows, const ImpactPlan& plan, Members some) {
    solve_pass(rows, Pass::kSolve, plan.efforts, some, [&](Members gains) {
        rows.start(Cause::kImpact, gains);
        rows.iterate(Pass::kSolve, plan.efforts, gains);
    });
}

/// Does the restitution of impacts, after the compression.
template <IslandRows Rows>
void restitute(Rows& rows, const ImpactPlan& plan, Members some) {
    rows.keep_impact_motion(some);
    // If all contacts have the same restitution, this is already the result.
    PerMember<double> parts;
    for (const int member : some) parts[member] = 1 + std::min(1.0, plan.impact[member].returned);
    if (rows.along_directions()) rows.leave_part(parts, some);
    solve_pass(rows, Pass::kRestitution, plan.efforts, some, [](Members) {});
    rows.add_changes(some);
    for (const int member : some)
        rows.leave_part_of_restitution(
            member, part_of_restitution(rows.restitution(member), plan.impact[member]));
}

/// Solves the impacts of islands by any kind of rows, see solve_impact() in solver.hpp.
template <IslandRows Rows>
void solve_impact(Rows& rows) {
    const ImpactPlan plan = plan_impacts(rows);
    if (!plan.hit.any()) return;
    rows.start(Cause::kImpact, rows.members());
    compress(rows, plan, plan.hit);
    const Members jammed = plan.hit.where([&](int member) {
        return can_jam(rows.simulation(), plan.impact[member]) && has_jammed(rows.energies(member));
    });
    if (jammed.any()) {
        rows.start(Cause::kImpact, jammed);
        noted(rows, rows.iterate(Pass::kFrictionless, plan.efforts, jammed), jammed);
    }
    const Members returning =
        plan.hit.where([&](int member) { return plan.impact[member].returned > 0; });
    if (returning.any()) restitute(rows, plan, returning);
    rows.add_changes(plan.hit - returning);
    rows.keep(plan.hit);
}

/// Cuts warm starts, which have acted already, to the part that may stay: see kWarmStartWeight.
template <IslandRows Rows>
void limit_warm_starts(Rows& rows) {
    PerMember<double> parts;
    const Members heavy = rows.members().where([&](int member) {
        const double weight = energy_of_fall(rows.simulation(), rows.step(), rows.island(member));
        return 0.5 * rows.energy(member) > kWarmStartWeight * weight;
    });
    for (const int member : heavy) parts[member] = rows.load(member).best_part();
    if (heavy.any()) rows.leave_part(parts, heavy);
}

/// Replaces loads that gain energy by the part of their warm start that takes the most energy.
template <IslandRows Rows>
void leave_best_of_warm_starts(Rows& rows, Members some) {
    rows.start(Cause::kLoad, some);
    PerMember<double> parts;
    const Members gains = some.where([&](int member) {
        const LoadWork load = rows.load(member);
        if (load.energy > 0) parts[member] = load.best_part();
        return load.energy > 0;
    });
    if (gains.any()) rows.leave_part(parts, gains);
}

/// Solves loads from their warm starts on.
template <IslandRows Rows>
PerMember<PassEnd> sweep_loads(Rows& rows) {
    const Members all = rows.members();
    rows.start(Cause::kLoad, all);
    PerMember<Effort> efforts;
    for (const int member : all)
        efforts[member] = effort_of_load(rows.simulation(), rows.step(), rows.island(member));
    const bool directions_do_it = Rows::kDropsGains && rows.along_directions();
    if (!directions_do_it) limit_warm_starts(rows);
    const auto instead = [&](Members some) { leave_best_of_warm_starts(rows, some); };
    const PerMember<PassEnd> ends = solve_pass(rows, Pass::kSolve, efforts, all, instead);
    if (directions_do_it || !Rows::kDropsGains) return ends;
    const Members gains = all.where([&](int member) {
        return ends[member].residual > efforts[member].enough && rows.load(member).is_gain();
    });
    if (gains.any()) instead(gains);
    return ends;
}

/// Prepares a load before its rows are made: its static load, and whether a position correction
/// follows.
inline void begin_load(const Simulation& simulation, StepData& step, std::size_t island) {
    hold_still(simulation, step, island);
    if (is_corrected(simulation, step, island)) step.corrected[island] = 1;
}

/// Returns the islands that have a position correction.
template <IslandRows Rows>
Members corrected(const Rows& rows) {
    return rows.members().where(
        [&](int member) { return rows.step().corrected[rows.island(member)] != 0; });
}

/// Solves the loads of islands, and their position corrections, by any kind of rows: see
/// solve_island() in solver.hpp.
template <IslandRows Rows>
void solve_load(Rows& rows) {
    const Simulation& simulation = rows.simulation();
    StepData& step = rows.step();
    const Members all = rows.members();
    for (const int member : all) begin_load(simulation, step, rows.island(member));
    const PerMember<PassEnd> ends = sweep_loads(rows);
    for (const int member : all) step.residual[rows.island(member)] = ends[member].residual;
    rows.keep(all);
    const Members corrects = corrected(rows);
    if (corrects.any()) {
        PerMember<Effort> efforts;
        for (const int member : corrects)
            efforts[member] = effort_of_correction(simulation.settings,
                                                   step.islands.size_of(rows.island(member)));
        rows.begin_correction(corrects);
        noted(rows, rows.iterate(Pass::kCorrection, efforts, corrects), corrects);
        rows.end_correction(corrects);
    }
    rows.add_changes(all);
}

/// Moves bodies by the position corrections of islands, see apply_correction() in solver.hpp.
template <IslandRows Rows>
void apply_correction(Rows& rows) {
    const Members corrects = corrected(rows);
    if (corrects.any()) rows.apply_correction(corrects);
}

}  // namespace tesserae
