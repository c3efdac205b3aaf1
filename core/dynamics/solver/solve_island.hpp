#pragma once

#include <algorithm>
#include <array>
#include <concepts>

#include "core/dynamics/solver/impact.hpp"
#include "core/dynamics/solver/static_loads.hpp"
#include "core/dynamics/solver/sweep.hpp"

// How an island is solved, once for both kinds of rows that it can have: PlainRows, one by one in
// double, and ColouredRows, eight or sixteen at a time in float.
namespace tesserae {

/// The rows of one island: what the solver needs of them.
template <class Rows>
concept IslandRows = requires(Rows& rows, Cause cause, Pass pass, const Effort& effort, double part,
                              const Impact& impact) {
    rows.simulation();
    rows.step();
    rows.island();
    // The largest numbers of its contacts, and how long an impact of it is swept.
    { rows.impact() } -> std::same_as<Impact>;
    { rows.effort_of(impact) } -> std::same_as<Effort>;
    // Makes the rows and applies the impulses that they start from to the motion that the
    // bodies had before the first call.
    rows.start(cause);
    // From the next start() on there is no friction.
    rows.leave_friction_out();
    // Sweeps a pass. Returns the residual of the last sweep [m/s].
    { rows.iterate(pass, effort) } -> std::same_as<double>;
    // What the impulses have done since start(): see LoadWork. The work takes longer.
    { rows.energy() } -> std::same_as<double>;
    { rows.load() } -> std::same_as<LoadWork>;
    // Leaves a part of the impulses and of what they have done.
    rows.leave_part(part);
    // An energy, or a multiple of it, before the impulses and after them.
    { rows.energies() } -> std::same_as<std::array<double, 2>>;
    // Puts what the bodies are at into step.impact_motion, as before and as compressed.
    rows.keep_impact_motion();
    // Gives the bodies the velocities that the impulses have led to.
    rows.add_changes();
    { rows.restitution() } -> std::same_as<RestitutionSums>;
    rows.leave_part_of_restitution(part);
    // step.impulses of the contacts, or of an impact step.hit.
    rows.keep();
    // Before and after the sweeps of a position correction; and once the bodies have moved by it.
    rows.begin_correction();
    rows.end_correction();
    rows.take_correction_back();
};

/// Whether rows go along conjugate directions: Rows::along_directions(impact) and
/// Rows::iterate_along_directions(effort, instead).
template <class Rows>
concept HasDirections = requires(Rows& rows) {
    rows.along_directions();
};

template <IslandRows Rows>
bool goes_along_directions(const Rows& rows) {
    if constexpr (HasDirections<Rows>)
        return rows.along_directions();
    else
        return false;
}

/// Along conjugate directions, or one sweep after the other.
/// @param instead   does that which is no gain, where the directions' end is one
/// @return the residual of the last sweep [m/s]
template <IslandRows Rows, class Instead>
double solve_pass(Rows& rows, bool along_directions, const Effort& effort, const Instead& instead) {
    if constexpr (HasDirections<Rows>)
        if (along_directions) return rows.iterate_along_directions(effort, instead);
    return rows.iterate(Pass::kSolve, effort);
}

/// The first part of an impact.
template <IslandRows Rows>
void compress(Rows& rows, bool along_directions, const Effort& effort) {
    rows.start(Cause::kImpact);
    solve_pass(rows, along_directions, effort, [&] {
        rows.start(Cause::kImpact);
        rows.iterate(Pass::kSolve, effort);
    });
}

/// The second part.
template <IslandRows Rows>
void restitute(Rows& rows, bool along_directions, const Impact& impact, const Effort& effort) {
    rows.keep_impact_motion();
    // Where all that hit each other return alike, that much more is all of it.
    if (along_directions) rows.leave_part(1 + std::min(1.0, impact.returned));
    rows.iterate(Pass::kRestitution, effort);
    rows.add_changes();
    rows.leave_part_of_restitution(part_of_restitution(rows.restitution(), impact));
}

/// See solve_impact() of an island.
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

/// Of the impulses that a load starts from, which have acted, the part that may stay: see
/// kWarmStartWeight.
template <IslandRows Rows>
void limit_warm_start(Rows& rows) {
    const Simulation& simulation = rows.simulation();
    const double weight = energy_of_fall(simulation, rows.step(), rows.island());
    if (!(0.5 * rows.energy() > LoadWork::least_of_stop(weight))) return;
    const LoadWork load = rows.load();
    if (load.is_too_much(weight, is_stopped(simulation, rows.step(), rows.island())))
        rows.leave_part(load.best_part());
}

/// Instead of a load that is a gain: the part of the last one that takes the most energy.
template <IslandRows Rows>
void leave_best_of_warm_start(Rows& rows) {
    rows.start(Cause::kLoad);
    const LoadWork load = rows.load();
    if (load.energy > 0) rows.leave_part(load.best_part());
}

/// @return the residual of the last sweep [m/s]
template <IslandRows Rows>
double sweep_load(Rows& rows) {
    rows.start(Cause::kLoad);
    const Effort effort = effort_of_load(rows.simulation(), rows.step(), rows.island());
    const bool along_directions = goes_along_directions(rows);
    if (!along_directions) limit_warm_start(rows);
    const auto instead = [&] { leave_best_of_warm_start(rows); };
    const double residual = solve_pass(rows, along_directions, effort, instead);
    // Plain rows keep theirs, which are a gain only where there are two or three sweeps.
    if constexpr (HasDirections<Rows>)
        if (!along_directions && residual > effort.enough && rows.load().is_gain()) instead();
    return residual;
}

/// Before the rows of a load.
inline void begin_load(const Simulation& simulation, StepData& step, std::size_t island) {
    hold_still(simulation, step, island);
    if (is_corrected(simulation, step, island)) step.corrected[island] = Correction::kAll;
}

/// See solve_island().
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
                     effort_of_correction(simulation, step.islands.contacts[island]));
        rows.end_correction();
    }
    rows.add_changes();
}

}  // namespace tesserae
