// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "core/dynamics/solver/conjugate_directions.hpp"
#include "core/dynamics/solver/solve_island.hpp"
#include "core/dynamics/solver/speed_of_loads.hpp"

namespace tesserae {

/// The IslandRows of a coloured island. Contacts are solved in float, eight at a time, and after
/// them, in each colour, all other constraints, one by one in double.
/// Velocities are changes since the sub-step's start, which are added to the state at the end.
/// Targets are relative to the start's velocities and are computed in double. So neither a body's
/// place nor its speed costs accuracy. The points of a pair are one item of a colour: its bodies
/// are read and written once for all of them.
///
/// The colours are the same for any number of threads, and so are the bits.
/// @tparam Threads   OneThread, or a class that has its functions
template <class Threads>
class ColouredRows {
  public:
    ColouredRows(const Simulation& simulation, StepData& step, std::size_t island,
                 const Threads& threads, LaneCount lanes = most_lanes())
        : island_(simulation, step, island), threads_(threads), lanes_(lanes) {}

    const Simulation& simulation() const { return stage().simulation; }
    StepData& step() const { return stage().step; }
    std::size_t island() const { return island_.number(); }

    Impact impact() const;
    Effort effort_of(const Impact& impact) const;
    bool along_directions() const { return step().islands.conjugates[island()]; }
    void start(Cause cause);
    void leave_friction_out() { island_.leave_friction_out(); }
    double iterate(Pass pass, const Effort& effort);
    template <class Instead>
    double iterate_along_directions(const Effort& effort, const Instead& instead);
    double energy() const;
    LoadWork load() const { return {work(), energy()}; }
    void leave_part(double part) { leave_part_of_load(island_, threads_, part); }
    std::array<double, 2> energies() const;
    void keep_impact_motion();
    void add_changes();
    RestitutionSums restitution() const;
    void leave_part_of_restitution(double part);
    void keep();
    void begin_correction();
    void end_correction();
    void take_correction_back();

  private:
    const ColouredStage& stage() const { return island_.stage(); }
    std::span<const BodyId> bodies_in(Range some) const {
        return {&step().coloured.bodies[some.begin], some.end - some.begin};
    }
    /// Calls work(stage, bodies) for pieces of the island's bodies.
    template <class Work>
    void for_bodies(const Work& work) const {
        threads_.for_bodies(island_.bodies(), [&](Range some) { work(stage(), some); });
    }
    /// Calls visit(ConstraintRows) for all constraints that are no contacts, on this thread.
    template <class Visit>
    void for_others(const Visit& visit) const {
        island_.for_colours(OneThread{}, LaneCount::kOne, false,
                            [&](const ColourBatches& batches, const auto&, LaneCount) {
                                visit(others_of(stage(), batches.others));
                            });
    }
    template <class Directions = NoDirections>
    double sweep(Sweep sweep, const Directions& directions = {});
    double work() const;
    double rounding_of_loads() const;

    ColouredIsland island_;
    const Threads& threads_;
    LaneCount lanes_;
};

template <class Threads>
Impact ColouredRows<Threads>::impact() const {
    const std::span<const std::uint32_t> runs = step().islands.runs_in(island());
    Impact all;
    for (const Impact& piece : results_of_pieces(threads_, {0, runs.size()}, [&](Range some) {
             return impact_of_runs(simulation(), step(),
                                   runs.subspan(some.begin, some.end - some.begin));
         }))
        all = larger_of(all, piece);
    return all;
}

template <class Threads>
Effort ColouredRows<Threads>::effort_of(const Impact& impact) const {
    const std::uint32_t contacts = step().islands.size_of(island());
    return impact.returned > 0 && along_directions()
               ? effort_of_bounce(simulation(), contacts, impact.fastest)
               : effort_of_large_impact(simulation(), contacts, impact.fastest);
}

/// Makes the rows of all contacts, unless an impact has made them before, and applies the impulses
/// that they start from.
template <class Threads>
void ColouredRows<Threads>::start(Cause cause) {
    island_.begin(cause);
    for_bodies([](auto... of) { begin_changes(of...); });
    island_.for_colours(
        threads_, lanes_, false,
        [&](const ColourBatches& batches, const auto& at_work, LaneCount at_once) {
            at_work.for_batches(batches.others, kManifoldPoints, [&](BatchRange some) {
                others_of(stage(), some).start(stage().cause);
            });
            at_work.for_batches(batches.round, 1,
                                [&](BatchRange some) { start_round(stage(), some, at_once); });
            at_work.for_batches(batches.general, kManifoldPoints,
                                [&](BatchRange some) { start_general(stage(), some, at_once); });
        });
    step().has_rows[island()] = 1;
}

/// Does one sweep over all rows.
/// @return its residual [m/s]
template <class Threads>
template <class Directions>
double ColouredRows<Threads>::sweep(Sweep sweep, const Directions& directions) {
    double residual = 0;
    island_.for_colours(
        threads_, lanes_, sweep.backward,
        [&](const ColourBatches& batches, const auto& at_work, LaneCount at_once) {
            const auto round = [&](BatchRange piece) {
                return directions.sweep_round(piece, sweep, [&](BatchRange some) {
                    return sweep_round(stage(), some, sweep, at_once);
                });
            };
            const auto general = [&](BatchRange piece) {
                return directions.sweep_general(piece, sweep, [&](BatchRange some) {
                    return sweep_general(stage(), some, sweep, at_once);
                });
            };
            const auto others = [&](BatchRange piece) {
                return directions.sweep_others(piece, sweep, [&](BatchRange some) {
                    return others_of(stage(), some).sweep(sweep, stage().cause);
                });
            };
            const auto sweep_others = [&] {
                residual =
                    std::max(residual, at_work.largest(batches.others, kManifoldPoints, others));
            };
            if (sweep.backward) sweep_others();
            double of_round = 0;
            if (!sweep.backward) of_round = at_work.largest(batches.round, 1, round);
            residual =
                std::max(residual, at_work.largest(batches.general, kManifoldPoints, general));
            if (sweep.backward) of_round = at_work.largest(batches.round, 1, round);
            residual = std::max(residual, of_round);
            if (!sweep.backward) sweep_others();
        });
    return residual;
}

template <class Threads>
double ColouredRows<Threads>::iterate(Pass pass, const Effort& effort) {
    return tesserae::iterate(pass, effort, [&](Sweep one) { return sweep(one); });
}

/// Sweeps along conjugate directions until neither a row's velocity, nor a body's by the next step
/// along the direction, changes by more than the tolerance, or than the rounding of the loads. The
/// second condition is for motions of a whole wall, which no row sees.
template <class Threads>
template <class Instead>
double ColouredRows<Threads>::iterate_along_directions(const Effort& effort,
                                                       const Instead& instead) {
    std::optional<ConjugateDirections<Threads>> directions;
    double residual = 0, smallest = std::numeric_limits<double>::infinity();
    std::optional<double> of_loads;
    const auto rounding = [&] {
        if (!of_loads) of_loads = effort.enough < 0 ? -1 : rounding_of_loads();
        return *of_loads;
    };
    const auto goes_on = [&](int i) {
        return i < effort.sweeps || (i < effort.further && directions && directions->holds());
    };
    for (int i = 0; goes_on(i); ++i) {
        Sweep one = sweep_of(Pass::kSolve, effort, i);
        one.adjoint = one.backward;
        if (one.backward && directions) directions->go_on();
        if (one.backward && !directions) directions.emplace(island_, threads_);
        residual = directions ? sweep(one, *directions) : sweep(one);
        if (one.measured && effort.leads_away(residual, smallest)) break;
        if (one.backward || !directions || i + 1 == std::max(effort.sweeps, effort.further))
            continue;
        const double left = std::max(residual, directions->find());
        if (effort.is_done(i + 1, left) || (i + 1 >= effort.least && left <= rounding())) break;
    }
    if (directions && residual > effort.enough && directions->is_gain()) {
        directions->take_back();
        instead();
    }
    return residual;
}

/// Returns the residual that float's rounding of the loads leaves: no sweep brings it down [m/s].
template <class Threads>
double ColouredRows<Threads>::rounding_of_loads() const {
    if (stage().cause != Cause::kLoad) return 0;
    const std::span<const std::uint32_t> runs = step().islands.runs_in(island());
    double largest = 0;
    for (const double piece : results_of_pieces(threads_, {0, runs.size()}, [&](Range some) {
             return speed_of_loads(simulation(), step(),
                                   runs.subspan(some.begin, some.end - some.begin));
         }))
        largest = std::max(largest, piece);
    return kRoundingOfLoads * largest;
}

template <class Threads>
double ColouredRows<Threads>::energy() const {
    const std::span<BodySums> sums = island_.body_sums();
    for_pieces(threads_, island_.bodies(), [&](std::size_t place, Range bodies) {
        sums[place][0] = energy_of_changes(stage(), bodies);
    });
    double energy = 0;
    for (const BodySums& piece : sums) energy += piece[0];
    for_others([&](const auto& others) { energy += others.twice_give(); });
    return energy;
}

/// Returns the work of the impulses as LoadWork has it [J].
template <class Threads>
double ColouredRows<Threads>::work() const {
    double work = 0;
    for_all_rows(
        island_, OneThread{},
        [&](BatchRange all) {
            for (std::uint32_t i = all.begin; i < all.end; ++i)
                work += load_work_of_round(stage(), i);
        },
        [&](BatchRange all) {
            for (std::uint32_t i = all.begin; i < all.end; ++i)
                work += load_work_of_general(stage(), i);
        },
        [](BatchRange) {});
    double of_others = 0;
    for_others([&](const auto& others) {
        others.for_all([&](const Constraint& c) { of_others -= c.impulse.dot(c.aim); });
    });
    return stage().mass_unit * work + of_others;
}

template <class Threads>
std::array<double, 2> ColouredRows<Threads>::energies() const {
    std::array<double, 2> sums = {};
    for (const auto& [before, after] :
         results_of_pieces(threads_, island_.bodies(),
                           [&](Range some) { return energies_of_compression(stage(), some); }))
        sums[0] += before, sums[1] += after;
    return sums;
}

template <class Threads>
void ColouredRows<Threads>::keep_impact_motion() {
    for_bodies([](auto... of) { tesserae::keep_impact_motion(of...); });
}

template <class Threads>
void ColouredRows<Threads>::add_changes() {
    for_bodies([](auto... of) { tesserae::add_changes(of...); });
}

template <class Threads>
RestitutionSums ColouredRows<Threads>::restitution() const {
    RestitutionSums sums;
    for (const RestitutionSums& piece : results_of_pieces(
             threads_, island_.bodies(),
             [&](Range some) { return restitution_of(simulation(), step(), bodies_in(some)); }))
        sums += piece;
    return sums;
}

template <class Threads>
void ColouredRows<Threads>::leave_part_of_restitution(double part) {
    threads_.for_bodies(island_.bodies(), [&](Range some) {
        tesserae::leave_part_of_restitution(simulation(), step(), bodies_in(some), part);
    });
}

template <class Threads>
void ColouredRows<Threads>::keep() {
    for_all_rows(
        island_, threads_, [&](BatchRange some) { keep_round(stage(), some); },
        [&](BatchRange some) { keep_general(stage(), some); },
        [&](BatchRange some) { others_of(stage(), some).keep(stage().cause); });
}

template <class Threads>
void ColouredRows<Threads>::begin_correction() {
    for_bodies([](auto... of) { tesserae::begin_correction(of...); });
}

template <class Threads>
void ColouredRows<Threads>::end_correction() {
    for_bodies([](auto... of) { tesserae::end_correction(of...); });
}

template <class Threads>
void ColouredRows<Threads>::take_correction_back() {
    for_bodies([](auto... of) { tesserae::take_correction_back(of...); });
}

/// Solves the impacts of a coloured island, see solve_impact().
template <class Threads>
void solve_coloured_impact(const Simulation& simulation, StepData& step, std::size_t island,
                           const Threads& threads, LaneCount lanes = most_lanes()) {
    ColouredRows rows(simulation, step, island, threads, lanes);
    solve_impact(rows);
}

/// Solves the load of a coloured island, see solve_island().
template <class Threads>
void solve_coloured_island(const Simulation& simulation, StepData& step, std::size_t island,
                           const Threads& threads, LaneCount lanes = most_lanes()) {
    begin_load(simulation, step, island);
    ColouredRows rows(simulation, step, island, threads, lanes);
    solve_load(rows);
}

/// Drops the position correction of a coloured island, see drop_correction().
template <class Threads>
void drop_coloured_correction(const Simulation& simulation, StepData& step, std::size_t island,
                              const Threads& threads) {
    if (step.corrected[island] != Correction::kNone)
        ColouredRows(simulation, step, island, threads).take_correction_back();
}

}  // namespace tesserae
