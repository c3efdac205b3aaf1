// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <concepts>

#include "core/dynamics/solver/impact.hpp"
#include "core/dynamics/solver/static_loads.hpp"
#include "core/dynamics/solver/sweep.hpp"

// How an island is solved. This one text serves both kinds of rows: PlainRows, one by one in
// double, and ColouredRows, eight or sixteen at a time in float.
namespace tesserae {

/// The rows of one island, with the functions that the solver needs.
template <class Rows>
concept IslandRows = requires(Rows& rows, Cause cause, Pass pass, const Effort& effort, double part,
                              const Impact& impact) {
    rows.simulation();
    rows.step();
    rows.island();
    // Returns the largest numbers of the island's contacts, and how long an impact is swept.
    { rows.impact() } -> std::same_as<Impact>;
    { rows.effort_of(impact) } -> std::same_as<Effort>;
    // Makes the rows and applies the impulses that they start from. The bodies first get back the
    // motion that they had before the first call.
    rows.start(cause);
    // Turns friction off from the next start() on.
    rows.leave_friction_out();
    // Sweeps a pass. Returns the residual of the last sweep [m/s].
    { rows.iterate(pass, effort) } -> std::same_as<double>;
    // Returns what the impulses have done since start(), see LoadWork. load() takes longer.
    { rows.energy() } -> std::same_as<double>;
    { rows.load() } -> std::same_as<LoadWork>;
    // Multiplies the impulses and what they have changed by a part.
    rows.leave_part(part);
    // Returns an energy, or a multiple of it, before the impulses and after them.
    { rows.energies() } -> std::same_as<std::array<double, 2>>;
    // Writes the bodies' motion before the impact and after the compression to
    // step.impact_motion.
    rows.keep_impact_motion();
    // Gives the bodies the velocities that the impulses have led to.
    rows.add_changes();
    { rows.restitution() } -> std::same_as<RestitutionSums>;
    rows.leave_part_of_restitution(part);
    // Writes step.impulses of the contacts, or step.hit after an impact.
    rows.keep();
    // Are called before and after the sweeps of a position correction, and once the bodies have
    // moved by it.
    rows.begin_correction();
    rows.end_correction();
    rows.take_correction_back();
};

/// Rows that may go along conjugate directions. They have along_directions() and
/// iterate_along_directions(effort, instead).
template <class Rows>
concept HasDirections = requires(Rows& rows) {
    rows.along_directions();
};

/// Returns whether the rows of this island go along conjugate directions.
template <IslandRows Rows>
bool goes_along_directions(const Rows& rows) {
    if constexpr (HasDirections<Rows>)
        return rows.along_directions();
    else
        return false;
}

/// Solves a pass along conjugate directions, or by one sweep after the other.
/// @param instead   is called if the directions end with a gain of energy, and replaces their
///                  result
/// @return the residual of the last sweep [m/s]
template <IslandRows Rows, class Instead>
double solve_pass(Rows& rows, bool along_directions, const Effort& effort, const Instead& instead) {
    if constexpr (HasDirections<Rows>)
        if (along_directions) return rows.iterate_along_directions(effort, instead);
    return rows.iterate(Pass::kSolve, effort);
}

/// Does the compression of an impact.
template <IslandRows Rows>
void compress(Rows& rows, bool along_directions, const Effort& effort) {
    rows.start(Cause::kImpact);
    solve_pass(rows, along_directions, effort, [&] {
        rows.start(Cause::kImpact);
        rows.iterate(Pass::kSolve, effort);
    });
}

/// Does the restitution of an impact, after the compression.
template <IslandRows Rows>
void restitute(Rows& rows, bool along_directions, const Impact& impact, const Effort& effort) {
    rows.keep_impact_motion();
    // If all contacts have the same restitution, this is already the result.
    if (along_directions) rows.leave_part(1 + std::min(1.0, impact.returned));
    rows.iterate(Pass::kRestitution, effort);
    rows.add_changes();
    rows.leave_part_of_restitution(part_of_restitution(rows.restitution(), impact));
}

/// Solves the impacts of an island by any kind of rows, see solve_impact() in solver.hpp.
template <IslandRows Rows>
void solve_impact(Rows& rows) {
    const Impact impact = rows.impact();
    if (impact.fastest == 0) return;
    rows.step().was_hit[rows.island()] = 1;
    const Effort effort = rows.effort_of(impact);
    const bool along_directions = impact.returned > 0 && goes_along_directions(rows);
    compress(rows, along_directions, effort);
    if (can_jam(rows.simulation(), impact) && has_jammed(rows.energies())) {
        rows.leave_friction_out();
        compress(rows, along_directions, effort);
    }
    if (impact.returned > 0)
        restitute(rows, along_directions, impact, effort);
    else
        rows.add_changes();
    rows.keep();
}

/// Cuts a warm start, which has acted already, to the part that may stay: see kWarmStartWeight.
template <IslandRows Rows>
void limit_warm_start(Rows& rows) {
    const Simulation& simulation = rows.simulation();
    const double weight = energy_of_fall(simulation, rows.step(), rows.island());
    if (0.5 * rows.energy() > kWarmStartWeight * weight) rows.leave_part(rows.load().best_part());
}

/// Replaces a load that gains energy by the part of its warm start that takes the most energy.
template <IslandRows Rows>
void leave_best_of_warm_start(Rows& rows) {
    rows.start(Cause::kLoad);
    const LoadWork load = rows.load();
    if (load.energy > 0) rows.leave_part(load.best_part());
}

/// Solves a load from its warm start on.
/// @return the residual of the last sweep [m/s]
template <IslandRows Rows>
double sweep_load(Rows& rows) {
    rows.start(Cause::kLoad);
    const Effort effort = effort_of_load(rows.simulation(), rows.step(), rows.island());
    const bool along_directions = goes_along_directions(rows);
    if (!along_directions) limit_warm_start(rows);
    const auto instead = [&] { leave_best_of_warm_start(rows); };
    const double residual = solve_pass(rows, along_directions, effort, instead);
    // Plain rows keep their load: it gains energy only where there are two or three sweeps.
    if constexpr (HasDirections<Rows>)
        if (!along_directions && residual > effort.enough && rows.load().is_gain()) instead();
    return residual;
}

/// Prepares a load before its rows are made: its static load, and whether a position correction
/// follows.
inline void begin_load(const Simulation& simulation, StepData& step, std::size_t island) {
    hold_still(simulation, step, island);
    if (is_corrected(simulation, step, island)) step.corrected[island] = Correction::kAll;
}

/// Solves the load of an island, and its position correction, by any kind of rows: see
/// solve_island() in solver.hpp.
template <IslandRows Rows>
void solve_load(Rows& rows) {
    const Simulation& simulation = rows.simulation();
    StepData& step = rows.step();
    const std::size_t island = rows.island();
    step.residual[island] = sweep_load(rows);
    rows.keep();
    if (step.corrected[island] != Correction::kNone) {
        rows.begin_correction();
        rows.iterate(Pass::kCorrection,
                     effort_of_correction(simulation, step.islands.size_of(island)));
        rows.end_correction();
    }
    rows.add_changes();
}

}  // namespace tesserae
