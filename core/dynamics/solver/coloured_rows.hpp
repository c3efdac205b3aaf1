// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "core/dynamics/solver/conjugate_directions.hpp"
#include "core/dynamics/solver/solve_island.hpp"
#include "core/dynamics/solver/speed_of_loads.hpp"

namespace tesserae {

/// The IslandRows of a group of coloured islands. Contacts are solved in float, eight at a time,
/// and after them, in each colour, all other constraints, one by one in double.
/// Velocities are changes since the sub-step's start, which are added to the state at the end.
/// Targets are relative to the start's velocities and are computed in double. So neither a body's
/// place nor its speed costs accuracy. The points of a pair are one item of a colour: its bodies
/// are read and written once for all of them.
///
/// The colours are the same for any number of threads, and so are the bits. What happens to an
/// island does not depend on the others of its group.
/// @tparam Threads   OneThread, or a class that has its functions
template <class Threads>
class ColouredRows {
  public:
    /// @param island   the first of its group
    ColouredRows(const Simulation& simulation, StepData& step, std::size_t island,
                 const Threads& threads, LaneCount lanes = most_lanes())
        : group_(simulation, step, island), threads_(threads), lanes_(lanes) {}

    const Simulation& simulation() const { return stage().simulation; }
    StepData& step() const { return stage().step; }
    Members members() const { return group_.members(); }
    std::size_t island(int member) const { return group_.island(member); }

    Impact impact(int member) const;
    Effort effort_of(int member, const Impact& impact) const;
    static constexpr bool kDropsGains = true;
    bool along_directions() const { return step().islands.conjugates[island(0)]; }
    void start(Cause cause, Members some);
    PerMember<PassEnd> iterate(Pass pass, const PerMember<Effort>& efforts, Members some);
    template <class Instead>
    PerMember<PassEnd> iterate_along_directions(Pass pass, const PerMember<Effort>& efforts,
                                                Members some, const Instead& instead);
    double energy(int member) const;
    LoadWork load(int member) const { return {work()[member], energy(member)}; }
    void leave_part(const PerMember<double>& parts, Members some) {
        leave_part_of_load(group_, threads_, parts, some);
    }
    std::array<double, 2> energies(int member) const;
    void keep_impact_motion(Members some);
    void add_changes(Members some);
    RestitutionSums restitution(int member) const;
    void leave_part_of_restitution(int member, double part);
    void keep(Members some);
    void begin_correction(Members some);
    void end_correction(Members some);
    void apply_correction(Members some);
    /// Does one sweep. Returns the residuals if they are measured.
    template <class Directions = NoDirections>
    PerMember<double> sweep(Sweep sweep, Members some, const Directions& directions = {});
    double rounding_of_loads(int member) const;

  private:
    const ColouredStage& stage() const { return group_.stage(); }
    std::span<const BodyId> bodies_in(Range some) const {
        return {&step().coloured.bodies[some.begin], some.end - some.begin};
    }
    /// Calls work(bodies) for pieces of the bodies of some islands.
    template <class Work>
    void for_bodies(Members some, const Work& work) const {
        for (const int member : some) threads_.for_bodies(group_.bodies(member), work);
    }
    /// Calls visit(ConstraintRows) for all constraints that are no contacts, on this thread.
    template <class Visit>
    void for_others(const Visit& visit) const {
        group_.for_colours(OneThread{}, LaneCount::kOne, false,
                           [&](const ColourBatches& batches, const auto&, LaneCount) {
                               visit(others_of(stage(), batches.others));
                           });
    }
    PerMember<double> residuals(double largest) const;
    PerMember<double> work() const;

    ColouredGroup group_;
    const Threads& threads_;
    LaneCount lanes_;
};

template <class Threads>
Impact ColouredRows<Threads>::impact(int member) const {
    const std::span<const std::uint32_t> runs = step().islands.runs_in(island(member));
    Impact all;
    for (const Impact& piece : results_of_pieces(threads_, {0, runs.size()}, [&](Range some) {
             return impact_of_runs(simulation(), step(),
                                   runs.subspan(some.begin, some.end - some.begin));
         }))
        all = larger_of(all, piece);
    return all;
}

template <class Threads>
Effort ColouredRows<Threads>::effort_of(int member, const Impact& impact) const {
    return effort_of_impact(simulation().settings, step().islands.size_of(island(member)), impact,
                            kLargeImpactResidual, along_directions());
}

/// Makes the rows of all contacts, unless an impact has made them before, and applies the impulses
/// that they start from. Rows are made of all islands at once.
template <class Threads>
void ColouredRows<Threads>::start(Cause cause, Members some) {
    group_.begin(cause);
    for (const int member : some)
        threads_.for_bodies(group_.bodies(member), [&](Range bodies) {
            begin_changes(stage(), bodies, group_.mass_unit(member));
        });
    group_.for_colours(
        threads_, lanes_, false,
        [&](const ColourBatches& batches, const auto& at_work, LaneCount at_once) {
            at_work.for_batches(batches.others, kManifoldPoints, [&](BatchRange others) {
                others_of(stage(), others).start(stage().cause);
            });
            at_work.for_batches(batches.round, 1, [&](BatchRange piece) {
                start_round(stage(), piece, at_once, some);
            });
            at_work.for_batches(batches.general, kManifoldPoints, [&](BatchRange piece) {
                start_general(stage(), piece, at_once, some);
            });
        });
    for (const int member : some) step().has_rows[island(member)] = 1;
}

/// Does one sweep over all rows of some islands.
/// @return their residuals [m/s]
template <class Threads>
template <class Directions>
PerMember<double> ColouredRows<Threads>::sweep(Sweep sweep, Members some,
                                               const Directions& directions) {
    double residual = 0;
    group_.for_colours(
        threads_, lanes_, sweep.backward,
        [&](const ColourBatches& batches, const auto& at_work, LaneCount at_once) {
            const auto round = [&](BatchRange piece) {
                return directions.sweep_round(piece, sweep, some, [&](BatchRange two) {
                    return sweep_round(stage(), two, sweep, at_once, some);
                });
            };
            const auto general = [&](BatchRange piece) {
                return directions.sweep_general(piece, sweep, some, [&](BatchRange two) {
                    return sweep_general(stage(), two, sweep, at_once, some);
                });
            };
            const auto others = [&](BatchRange piece) {
                return directions.sweep_others(piece, sweep, [&](BatchRange two) {
                    return others_of(stage(), two).sweep(sweep, stage().cause);
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
    return sweep.measured ? residuals(residual) : PerMember<double>{};
}

/// Returns each island's residual after a sweep that was measured.
/// @param largest   of all islands
template <class Threads>
PerMember<double> ColouredRows<Threads>::residuals(double largest) const {
    PerMember<double> residual;
    residual[0] = largest;
    if (!stage().shares_batches) return residual;
    residual[0] = 0;
    const ColouredIslands& coloured = step().coloured;
    const auto add = [&](int member, const Eight& left, std::size_t k) {
        residual[member] = std::max<double>(residual[member], left.lane[k]);
    };
    group_.for_colours(
        OneThread{}, LaneCount::kOne, false,
        [&](const ColourBatches& batches, const auto&, LaneCount) {
            for_lanes_of_members(coloured.round, batches.round, coloured.round_left, add);
            for_lanes_of_members(coloured.general, batches.general, coloured.general_left, add);
        });
    return residual;
}

template <class Threads>
PerMember<PassEnd> ColouredRows<Threads>::iterate(Pass pass, const PerMember<Effort>& efforts,
                                                  Members some) {
    return tesserae::iterate(pass, efforts, some,
                             [&](Sweep one, Members swept) { return sweep(one, swept); });
}

/// Restitution has no directions.
template <class Threads>
template <class Instead>
PerMember<PassEnd> ColouredRows<Threads>::iterate_along_directions(Pass pass,
                                                                   const PerMember<Effort>& efforts,
                                                                   Members some,
                                                                   const Instead& instead) {
    if (pass == Pass::kRestitution) {
        return iterate(pass, efforts, some);
    }
    ConjugateDirections<Threads> directions(group_, threads_);
    return AlongDirections(*this, directions, pass, efforts).solve(some, instead);
}

/// Returns the residual that float's rounding of an island's loads leaves: no sweep brings it down
/// [m/s].
template <class Threads>
double ColouredRows<Threads>::rounding_of_loads(int member) const {
    if (stage().cause != Cause::kLoad) return 0;
    const std::span<const std::uint32_t> runs = step().islands.runs_in(island(member));
    double largest = 0;
    for (const double piece : results_of_pieces(threads_, {0, runs.size()}, [&](Range some) {
             return speed_of_loads(simulation(), step(),
                                   runs.subspan(some.begin, some.end - some.begin));
         }))
        largest = std::max(largest, piece);
    return kRoundingOfLoads * largest;
}

template <class Threads>
double ColouredRows<Threads>::energy(int member) const {
    const std::span<BodySums> sums = group_.body_sums(member);
    for_pieces(threads_, group_.bodies(member), [&](std::size_t place, Range bodies) {
        sums[place][0] = energy_of_changes(stage(), bodies);
    });
    double energy = 0;
    for (const BodySums& piece : sums) energy += piece[0];
    for_others([&](const auto& others) { energy += others.twice_give(); });
    return energy;
}

/// Returns the work of each island's impulses as LoadWork has it [J].
template <class Threads>
PerMember<double> ColouredRows<Threads>::work() const {
    PerMember<double> work;
    const auto add = [&](const std::vector<Batch>& all, BatchRange batches, const auto& of_batch) {
        for (std::uint32_t i = batches.begin; i < batches.end; ++i) {
            const Eight lanes = of_batch(stage(), i);
            for (std::size_t k = 0; k < kLanes && all[i].points[k] > 0; ++k)
                work[all[i].member[k]] += lanes.lane[k];
        }
    };
    const ColouredIslands& coloured = step().coloured;
    for_all_rows(
        group_, OneThread{}, [&](BatchRange all) { add(coloured.round, all, load_work_of_round); },
        [&](BatchRange all) { add(coloured.general, all, load_work_of_general); },
        [](BatchRange) {});
    for (const int member : members()) work[member] *= group_.mass_unit(member);
    for_others([&](const auto& others) {
        others.for_all([&](const Constraint& c) { work[0] -= c.impulse.dot(c.aim); });
    });
    return work;
}

template <class Threads>
std::array<double, 2> ColouredRows<Threads>::energies(int member) const {
    std::array<double, 2> sums = {};
    for (const auto& [before, after] :
         results_of_pieces(threads_, group_.bodies(member),
                           [&](Range some) { return energies_of_compression(stage(), some); }))
        sums[0] += before, sums[1] += after;
    return sums;
}

template <class Threads>
void ColouredRows<Threads>::keep_impact_motion(Members some) {
    for_bodies(some, [&](Range bodies) { tesserae::keep_impact_motion(stage(), bodies); });
}

template <class Threads>
void ColouredRows<Threads>::add_changes(Members some) {
    for_bodies(some, [&](Range bodies) { tesserae::add_changes(stage(), bodies); });
}

template <class Threads>
RestitutionSums ColouredRows<Threads>::restitution(int member) const {
    RestitutionSums sums;
    for (const RestitutionSums& piece : results_of_pieces(
             threads_, group_.bodies(member),
             [&](Range some) { return restitution_of(simulation(), step(), bodies_in(some)); }))
        sums += piece;
    return sums;
}

template <class Threads>
void ColouredRows<Threads>::leave_part_of_restitution(int member, double part) {
    threads_.for_bodies(group_.bodies(member), [&](Range some) {
        tesserae::leave_part_of_restitution(simulation(), step(), bodies_in(some), part);
    });
}

template <class Threads>
void ColouredRows<Threads>::keep(Members some) {
    for_all_rows(
        group_, threads_, [&](BatchRange batches) { keep_round(stage(), batches, some); },
        [&](BatchRange batches) { keep_general(stage(), batches, some); },
        [&](BatchRange others) { others_of(stage(), others).keep(stage().cause); });
}

template <class Threads>
void ColouredRows<Threads>::begin_correction(Members some) {
    for_bodies(some, [&](Range bodies) { tesserae::begin_correction(stage(), bodies); });
}

template <class Threads>
void ColouredRows<Threads>::end_correction(Members some) {
    for_bodies(some, [&](Range bodies) { tesserae::end_correction(stage(), bodies); });
}

template <class Threads>
void ColouredRows<Threads>::apply_correction(Members some) {
    for_bodies(some, [&](Range bodies) { tesserae::apply_correction(stage(), bodies); });
}

// The functions of solver.hpp for the group of coloured islands that an island leads. They do
// nothing for the other islands of a group.

template <class Threads>
void solve_coloured_impact(const Simulation& simulation, StepData& step, std::size_t island,
                           const Threads& threads, LaneCount lanes = most_lanes()) {
    if (!step.coloured.leads(step.islands.coloured[island])) return;
    ColouredRows rows(simulation, step, island, threads, lanes);
    solve_impact(rows);
}

template <class Threads>
void solve_coloured_island(const Simulation& simulation, StepData& step, std::size_t island,
                           const Threads& threads, LaneCount lanes = most_lanes()) {
    if (!step.coloured.leads(step.islands.coloured[island])) return;
    ColouredRows rows(simulation, step, island, threads, lanes);
    solve_load(rows);
}

template <class Threads>
void apply_coloured_correction(const Simulation& simulation, StepData& step, std::size_t island,
                               const Threads& threads) {
    if (!step.coloured.leads(step.islands.coloured[island])) return;
    ColouredRows rows(simulation, step, island, threads);
    apply_correction(rows);
}

}  // namespace tesserae
