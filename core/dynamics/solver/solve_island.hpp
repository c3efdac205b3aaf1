#pragma once

#include <algorithm>
#include <array>
#include <concepts>

#include "core/dynamics/solver/blow.hpp"
#include "core/dynamics/solver/static_loads.hpp"
#include "core/dynamics/solver/sweep.hpp"

// How an island is solved, once for both kinds of rows that it can have: PlainRows, one by one in
// double, and ColouredRows, eight or sixteen at a time in float.
namespace tesserae {

/// The rows of one island: what the solver needs of them.
template <class Rows>
concept IslandRows = requires(Rows& rows, Cause cause, Pass pass, const Effort& effort, double part,
                              const Blow& blow) {
    rows.simulation();
    rows.step();
    rows.island();
    // The largest numbers of its contacts, and how long a blow of it is swept.
    { rows.blow() } -> std::same_as<Blow>;
    { rows.effort_of(blow) } -> std::same_as<Effort>;
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
    // Puts what the bodies are at into step.blow_motion, as before and as compressed.
    rows.keep_blow_motion();
    // Gives the bodies the velocities that the impulses have led to.
    rows.add_changes();
    { rows.restitution() } -> std::same_as<RestitutionSums>;
    rows.leave_part_of_restitution(part);
    // step.impulses of the contacts, or of a blow step.hit.
    rows.keep();
    // Before and after the sweeps of a push; and once the bodies have moved by it.
    rows.begin_push();
    rows.end_push();
    rows.take_push_back();
};

/// Whether rows go along conjugate directions: Rows::along_directions(blow) and
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

/// The first part of a blow.
template <IslandRows Rows>
void compress(Rows& rows, bool along_directions, const Effort& effort) {
    rows.start(Cause::kBlow);
    solve_pass(rows, along_directions, effort, [&] {
        rows.start(Cause::kBlow);
        rows.iterate(Pass::kSolve, effort);
    });
}

/// The second part.
template <IslandRows Rows>
void restitute(Rows& rows, bool along_directions, const Blow& blow, const Effort& effort) {
    rows.keep_blow_motion();
    // Where all that hit each other return alike, that much more is all of it.
    if (along_directions) rows.leave_part(1 + std::min(1.0, blow.returned));
    rows.iterate(Pass::kRestitution, effort);
    rows.add_changes();
    rows.leave_part_of_restitution(part_of_restitution(rows.restitution(), blow));
}

/// See solve_blow() of an island.
template <IslandRows Rows>
void solve_blow(Rows& rows) {
    const Blow blow = rows.blow();
    if (blow.fastest == 0) return;
    rows.step().was_hit[rows.island()] = 1;
    const Effort effort = rows.effort_of(blow);
    const bool along_directions = blow.returned > 0 && goes_along_directions(rows);
    compress(rows, along_directions, effort);
    if (can_jam(rows.simulation(), blow) && has_jammed(rows.energies())) {
        rows.leave_friction_out();
        compress(rows, along_directions, effort);
    }
    if (blow.returned > 0)
        restitute(rows, along_directions, blow, effort);
    else
        rows.add_changes();
    rows.keep();
}

/// Of the impulses that a load starts from, which have acted, the part that may stay: see
/// kRecalledWeight.
template <IslandRows Rows>
void leave_recalled(Rows& rows) {
    const Simulation& simulation = rows.simulation();
    const double weight = energy_of_fall(simulation, rows.step(), rows.island());
    if (!(0.5 * rows.energy() > LoadWork::least_of_stop(weight))) return;
    const LoadWork load = rows.load();
    if (load.is_too_much(weight, is_stopped(simulation, rows.step(), rows.island())))
        rows.leave_part(load.best_part());
}

/// Instead of a load that is a gain: the part of the last one that takes the most energy.
template <IslandRows Rows>
void leave_best_of_recalled(Rows& rows) {
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
    if (!along_directions) leave_recalled(rows);
    const auto instead = [&] { leave_best_of_recalled(rows); };
    const double residual = solve_pass(rows, along_directions, effort, instead);
    // Plain rows keep theirs, which are a gain only where there are two or three sweeps.
    if constexpr (HasDirections<Rows>)
        if (!along_directions && residual > effort.enough && rows.load().is_gain()) instead();
    return residual;
}

/// Before the rows of a load.
inline void begin_load(const Simulation& simulation, StepData& step, std::size_t island) {
    hold_still(simulation, step, island);
    if (is_pushed(simulation, step, island)) step.pushed[island] = Push::kAll;
}

/// See solve_island().
template <IslandRows Rows>
void solve_load(Rows& rows) {
    const Simulation& simulation = rows.simulation();
    StepData& step = rows.step();
    const std::size_t island = rows.island();
    step.residual[island] = sweep_load(rows);
    rows.keep();
    if (step.pushed[island] != Push::kNone) {
        rows.begin_push();
        rows.iterate(Pass::kPush, effort_of_push(simulation, step.islands.contacts[island]));
        rows.end_push();
    }
    rows.add_changes();
}

}  // namespace tesserae
