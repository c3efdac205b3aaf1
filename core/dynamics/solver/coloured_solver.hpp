#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "core/dynamics/solver/blow.hpp"
#include "core/dynamics/solver/conjugate_directions.hpp"
#include "core/dynamics/solver/static_loads.hpp"

namespace tesserae {

// Coloured islands are solved in float, eight contacts at a time: velocities as changes since the
// sub-step's start, which are added to the state at the end, and targets less what the start has,
// worked out in double. So neither a body's place nor its speed costs accuracy. The points of a
// pair are one item of a colour: its bodies are read and written once for all of them.
//
// The colours are the same for any number of threads, and so are the bits.

/// One iteration.
/// @return its residual [m/s]
template <class Threads, class Directions = NoDirections>
double sweep_coloured(const ColouredIsland& island, Sweep sweep, const Threads& threads,
                      LaneCount lanes, const Directions& directions = {}) {
    const ColouredStage& stage = island.stage();
    double residual = 0;
    island.for_colours(threads, lanes, sweep.backward,
                       [&](const ColourBatches& batches, const auto& at_work, LaneCount at_once) {
                           const auto round = [&](BatchRange piece) {
                               return directions.sweep_round(piece, sweep, [&](BatchRange some) {
                                   return sweep_round(stage, some, sweep, at_once);
                               });
                           };
                           const auto general = [&](BatchRange piece) {
                               return directions.sweep_general(piece, sweep, [&](BatchRange some) {
                                   return sweep_general(stage, some, sweep, at_once);
                               });
                           };
                           double of_round = 0;
                           if (!sweep.backward) of_round = at_work.largest(batches.round, 1, round);
                           residual = std::max(residual, at_work.largest(batches.general,
                                                                         kManifoldPoints, general));
                           if (sweep.backward) of_round = at_work.largest(batches.round, 1, round);
                           residual = std::max(residual, of_round);
                       });
    return residual;
}

/// @return the residual of the last iteration [m/s]
template <class Threads>
double iterate_coloured(const ColouredIsland& island, Pass pass, const Effort& effort,
                        const Threads& threads, LaneCount lanes) {
    return iterate(pass, effort,
                   [&](Sweep sweep) { return sweep_coloured(island, sweep, threads, lanes); });
}

/// The rows of all contacts, and the impulses that they start from.
template <class Threads>
void start_coloured(const ColouredIsland& island, const Threads& threads, LaneCount lanes) {
    const ColouredStage& stage = island.stage();
    threads.for_bodies(island.bodies(), [&](Range bodies) { begin_changes(stage, bodies); });
    island.for_colours(
        threads, lanes, false,
        [&](const ColourBatches& batches, const auto& at_work, LaneCount at_once) {
            at_work.for_batches(batches.round, 1,
                                [&](BatchRange piece) { start_round(stage, piece, at_once); });
            at_work.for_batches(batches.general, kManifoldPoints,
                                [&](BatchRange piece) { start_general(stage, piece, at_once); });
        });
}

/// Of the impulses as they are.
inline double work_of_load(const ColouredIsland& island) {
    const ColouredStage& stage = island.stage();
    double work = 0;
    for_all_rows(
        island, OneThread{},
        [&](BatchRange all) {
            for (std::uint32_t i = all.begin; i < all.end; ++i)
                work += load_work_of_round(stage, i);
        },
        [&](BatchRange all) {
            for (std::uint32_t i = all.begin; i < all.end; ++i)
                work += load_work_of_general(stage, i);
        });
    return stage.mass_unit * work;
}
/// Twice the kinetic energy of what they have changed [J].
template <class Threads>
double energy_of_load(const ColouredIsland& island, const Threads& threads) {
    const std::span<BodySums> sums = island.body_sums();
    for_pieces(threads, island.bodies(), [&](std::size_t place, Range bodies) {
        sums[place][0] = energy_of_changes(island.stage(), bodies);
    });
    double energy = 0;
    for (const BodySums& piece : sums) energy += piece[0];
    return energy;
}

template <class Threads>
LoadWork load_of(const ColouredIsland& island, const Threads& threads) {
    return {work_of_load(island), energy_of_load(island, threads)};
}

/// Instead of a load that is a gain: the part of the last one that takes the most energy.
template <class Threads>
void leave_best_of_recalled(const ColouredIsland& island, const Threads& threads, LaneCount lanes) {
    start_coloured(island, threads, lanes);
    const LoadWork load = load_of(island, threads);
    if (load.energy > 0) leave_part_of_load(island, threads, load.best_part());
}

/// A load, or a compression, by conjugate directions. It ends once neither a row's velocity nor, by
/// the next step, a body's changes by more than the tolerance: what all of a wall does together no
/// row sees.
/// @param instead   does that which is no gain, where this is one
/// @return the residual of the last iteration [m/s]
template <class Threads, class Instead>
double iterate_along_conjugates(const ColouredIsland& island, const Effort& effort,
                                const Threads& threads, LaneCount lanes, const Instead& instead) {
    std::optional<ConjugateDirections<Threads>> directions;
    double residual = 0, smallest = std::numeric_limits<double>::infinity();
    const auto goes_on = [&](int i) {
        return i < effort.sweeps || (i < effort.further && directions && directions->holds());
    };
    for (int i = 0; goes_on(i); ++i) {
        Sweep sweep = sweep_of(Pass::kSolve, effort, i);
        sweep.adjoint = sweep.backward;
        // Before that it does not end, whatever is left.
        sweep.measured &= i + 1 >= std::min(effort.least, effort.sweeps);
        if (sweep.backward && directions) directions->go_on();
        if (sweep.backward && !directions) directions.emplace(island, threads);
        residual = directions ? sweep_coloured(island, sweep, threads, lanes, *directions)
                              : sweep_coloured(island, sweep, threads, lanes);
        if (sweep.measured && effort.leads_away(residual, smallest)) break;
        if (sweep.backward || !directions || i + 1 == std::max(effort.sweeps, effort.further))
            continue;
        const double left = std::max(residual, directions->find());
        if (i + 1 >= effort.least && left <= effort.enough) break;
    }
    if (directions && residual > effort.enough && directions->is_gain()) {
        directions->take_back();
        instead();
    }
    return residual;
}

/// What keep_round() and keep_general() keep of all contacts.
template <class Threads>
void keep_coloured(const ColouredIsland& island, const Threads& threads) {
    const ColouredStage& stage = island.stage();
    island.for_colours(threads, LaneCount::kOne, false,
                       [&](const ColourBatches& batches, const auto& at_work, LaneCount) {
                           at_work.for_batches(batches.round, 1,
                                               [&](BatchRange piece) { keep_round(stage, piece); });
                           at_work.for_batches(
                               batches.general, kManifoldPoints,
                               [&](BatchRange piece) { keep_general(stage, piece); });
                       });
}

/// The first part of a blow.
template <class Threads>
void compress_coloured(const ColouredIsland& island, bool along_conjugates, const Effort& effort,
                       const Threads& threads, LaneCount lanes) {
    const auto sweep = [&] { iterate_coloured(island, Pass::kSolve, effort, threads, lanes); };
    start_coloured(island, threads, lanes);
    if (!along_conjugates) return sweep();
    iterate_along_conjugates(island, effort, threads, lanes, [&] {
        start_coloured(island, threads, lanes);
        sweep();
    });
}

/// The largest numbers of an island's contacts.
template <class Threads>
Blow blow_of_coloured(const Simulation& simulation, const StepData& step, std::size_t island,
                      const Threads& threads) {
    const std::span<const std::uint32_t> runs = step.islands.runs_in(island);
    Blow all;
    for (const Blow& piece : results_of_pieces(threads, {0, runs.size()}, [&](Range some) {
             return blow_of_runs(simulation, step, runs.subspan(some.begin, some.end - some.begin));
         }))
        all = larger_of(all, piece);
    return all;
}

/// Whether friction has in the compression, see can_jam().
template <class Threads>
bool has_jammed(const ColouredIsland& island, const Threads& threads) {
    double before = 0, after = 0;
    for (const auto& [first, last] : results_of_pieces(threads, island.bodies(), [&](Range bodies) {
             return energies_of_compression(island.stage(), bodies);
         }))
        before += first, after += last;
    return has_jammed(before, after);
}

/// Cuts what restitution gave to the island's bodies, see RestitutionSums.
template <class Threads>
void limit_restitution(const ColouredIsland& island, const Blow& blow, const Threads& threads) {
    const Simulation& simulation = island.stage().simulation;
    StepData& step = island.stage().step;
    const auto bodies_in = [&](Range some) {
        return std::span<const BodyId>(&step.coloured.bodies[some.begin], some.end - some.begin);
    };
    RestitutionSums sums;
    for (const RestitutionSums& piece : results_of_pieces(
             threads, island.bodies(),
             [&](Range some) { return restitution_of(simulation, step, bodies_in(some)); }))
        sums += piece;
    const double part = part_of_restitution(sums, blow);
    threads.for_bodies(island.bodies(), [&](Range some) {
        leave_part_of_restitution(simulation, step, bodies_in(some), part);
    });
}

/// solve_blow() of a coloured island.
template <class Threads>
void solve_coloured_blow(const Simulation& simulation, StepData& step, std::size_t island,
                         const Threads& threads, LaneCount lanes = most_lanes()) {
    const Blow blow = blow_of_coloured(simulation, step, island, threads);
    if (blow.fastest == 0) return;
    step.was_hit[island] = 1;
    const ColouredIsland coloured(simulation, step, island, Cause::kBlow);
    const ColouredStage& stage = coloured.stage();
    const std::uint32_t contacts = step.islands.contacts[island];
    const bool bounces = blow.returned > 0 && step.islands.conjugates[island];
    const Effort effort = bounces ? effort_of_bounce(simulation, contacts, blow.fastest)
                                  : effort_of_large_blow(simulation, contacts, blow.fastest);
    const Range range = coloured.bodies();
    compress_coloured(coloured, bounces, effort, threads, lanes);
    step.has_rows[island] = 1;
    if (can_jam(simulation, blow) && has_jammed(coloured, threads))
        compress_coloured(ColouredIsland(simulation, step, island, Cause::kBlow, false), bounces,
                          effort, threads, lanes);
    const auto add = [&](Range some) { add_changes(stage, some); };
    if (blow.returned == 0) {
        threads.for_bodies(range, add);
        return keep_coloured(coloured, threads);
    }
    threads.for_bodies(range, [&](Range some) { keep_blow_motion(stage, some); });
    // Where all that hit each other return alike, that much more is all of it.
    if (bounces) leave_part_of_load(coloured, threads, 1 + std::min(1.0, blow.returned));
    iterate_coloured(coloured, Pass::kRestitution, effort, threads, lanes);
    threads.for_bodies(range, add);
    limit_restitution(coloured, blow, threads);
    keep_coloured(coloured, threads);
}

/// What the load starts from has acted; see kRecalledWeight.
template <class Threads>
void leave_recalled(const ColouredIsland& island, const Threads& threads) {
    const Simulation& simulation = island.stage().simulation;
    const StepData& step = island.stage().step;
    const double weight = energy_of_fall(simulation, step, island.number());
    const double energy = energy_of_load(island, threads);
    if (!(0.5 * energy > LoadWork::least_of_stop(weight))) return;
    const LoadWork load = {work_of_load(island), energy};
    if (load.is_too_much(weight, is_stopped(simulation, step, island.number())))
        leave_part_of_load(island, threads, load.best_part());
}

/// solve_island() of a coloured island.
template <class Threads>
void solve_coloured_island(const Simulation& simulation, StepData& step, std::size_t island,
                           const Threads& threads, LaneCount lanes = most_lanes()) {
    hold_still(simulation, step, island);
    if (is_pushed(simulation, step, island)) step.pushed[island] = Push::kAll;
    const ColouredIsland coloured(simulation, step, island, Cause::kLoad);
    const ColouredStage& stage = coloured.stage();
    start_coloured(coloured, threads, lanes);
    const Effort effort = effort_of_load(simulation, step, island);
    if (step.islands.conjugates[island]) {
        step.residual[island] = iterate_along_conjugates(coloured, effort, threads, lanes, [&] {
            leave_best_of_recalled(coloured, threads, lanes);
        });
    } else {
        leave_recalled(coloured, threads);
        step.residual[island] = iterate_coloured(coloured, Pass::kSolve, effort, threads, lanes);
        if (step.residual[island] > effort.enough && load_of(coloured, threads).is_gain())
            leave_best_of_recalled(coloured, threads, lanes);
    }
    keep_coloured(coloured, threads);
    if (step.pushed[island] != Push::kNone) {
        threads.for_bodies(coloured.bodies(), [&](Range bodies) { begin_push(stage, bodies); });
        iterate_coloured(coloured, Pass::kPush,
                         effort_of_push(simulation, step.islands.contacts[island]), threads, lanes);
        threads.for_bodies(coloured.bodies(), [&](Range bodies) { end_push(stage, bodies); });
    }
    threads.for_bodies(coloured.bodies(), [&](Range bodies) { add_changes(stage, bodies); });
}

/// drop_correction() of a coloured island.
template <class Threads>
void drop_coloured_correction(const Simulation& simulation, StepData& step, std::size_t island,
                              const Threads& threads) {
    if (step.pushed[island] == Push::kNone) return;
    const ColouredIsland coloured(simulation, step, island, Cause::kLoad);
    threads.for_bodies(coloured.bodies(),
                       [&](Range bodies) { take_push_back(coloured.stage(), bodies); });
}

}  // namespace tesserae
