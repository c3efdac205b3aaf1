// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/solver/coloured_island.hpp"
#include "core/dynamics/solver/conjugate.hpp"
#include "core/dynamics/solver/island_directions.hpp"

namespace tesserae {

/// Pairs of sweeps along conjugate directions over islands that are solved side by side.
template <class Threads>
class ConjugateDirections {
  public:
    ConjugateDirections(const ColouredGroup& group, const Threads& threads)
        : group_(group), threads_(threads) {}

    /// Returns the islands that have begun.
    Members begun() const { return begun_; }
    /// Begins with some islands: takes their warm starts.
    void begin(Members some) {
        if (!some.any()) return;
        begun_ = begun_ | some;
        const ColouredStage& stage = group_.stage();
        PerMember<double> warm_start;
        const Members heavy = some.where([&](int member) {
            double weight = 0;
            const double unit = group_.mass_unit(member);
            for (const BodySums& piece :
                 sums_of(member, [&](auto... of) { return weigh_warm_start(stage, of..., unit); }))
                warm_start[member] += piece[0], weight += piece[1];
            return warm_start[member] > kWarmStartWeight * weight;
        });
        if (heavy.any()) leave_part_of_warm_starts(warm_start, heavy);
        for_all_rows(
            group_, threads_,
            [&](BatchRange batches) { take_warm_start_round(stage, batches, some); },
            [&](BatchRange batches) { take_warm_start_general(stage, batches, some); },
            [&](BatchRange others) { others_of(stage, others).take_warm_start(); });
        for (const int member : some) {
            of_[member] = IslandDirections(warm_start[member], kFloatStep);
            for_bodies(member, [&](Range bodies) { add_changes(stage, bodies); });
            for_bodies(member, [&](Range bodies) { take_warm_start(stage, bodies); });
            for_bodies(member, [&](Range bodies) { begin_directions(stage, bodies); });
        }
    }
    /// Finds the directions after a pair of sweeps.
    /// @return the largest change of a body's velocity by a step along them [m/s]
    PerMember<double> find(Members some) {
        PerMember<double> largest;
        if (!some.any()) return largest;
        const PerMember<RowSums> rows = sums_of_rows();
        for (const int member : some) largest[member] = find(member, rows[member]);
        return largest;
    }
    /// Returns whether an island's next pair of sweeps begins with a step along the direction.
    bool holds(int member) const { return begun_.has(member) && of_[member].holds(); }
    /// Begins the next pair of sweeps of some islands that have begun.
    void go_on(Members some) {
        const ColouredStage& stage = group_.stage();
        steps_.along = some.where([&](int member) { return of_[member].holds(); });
        for (const int member : some) {
            IslandDirections& of = of_[member];
            steps_.carried[member] = of.carried(), steps_.length[member] = of.length();
            for_bodies(member, [&](Range bodies) {
                if (of.holds())
                    go_along(stage, bodies, of.length());
                else
                    begin_directions(stage, bodies);
            });
            of.go_on();
        }
    }

    /// Returns, after the last pair, whether all impulses together with the warm start leave more
    /// energy than none would.
    bool is_gain(int member) const {
        return weigh(member)[2] + sums_of_rows()[member].of_all - of_[member].warm_start() > 0;
    }
    /// Takes the warm start back: no impulses have acted then.
    void take_back(Members some) const {
        for (const int member : some)
            for_bodies(member, [&](Range bodies) { take_warm_start_back(group_.stage(), bodies); });
    }

    // The rows' part of a pair of sweeps. It is done batch by batch as they are swept, while they
    // are in the caches.
    /// Sweeps batches of round pairs of some islands, with their part of the directions.
    /// @param work   sweeps batches and returns their residual
    template <class Work>
    double sweep_round(BatchRange batches, Sweep sweep, Members some, const Work& work) const {
        const ColouredStage& stage = group_.stage();
        const std::vector<Batch>& all = stage.step.coloured.round;
        return largest_of_twos(all, batches, sweep.backward, some, [&](BatchRange two) {
            if (sweep.backward) go_along_round(stage, two, steps_);
            const double left = work(two);
            if (!sweep.backward) weigh_round_step(stage, two);
            return left;
        });
    }
    /// Sweeps batches of all other pairs, with their part of the directions.
    template <class Work>
    double sweep_general(BatchRange batches, Sweep sweep, Members some, const Work& work) const {
        const ColouredStage& stage = group_.stage();
        const std::vector<Batch>& all = stage.step.coloured.general;
        return largest_of_twos(all, batches, sweep.backward, some, [&](BatchRange two) {
            if (sweep.backward) go_along_general(stage, two, steps_);
            const double left = work(two);
            if (!sweep.backward) weigh_general_step(stage, two);
            return left;
        });
    }
    /// Sweeps constraints that are no contacts, with their part of the directions.
    template <class Work>
    double sweep_others(BatchRange others, Sweep sweep, const Work& work) const {
        const ColouredStage& stage = group_.stage();
        if (sweep.backward) go_along_others(stage, others, steps_);
        const double left = work(others);
        if (!sweep.backward) weigh_others_step(stage, others);
        return left;
    }

  private:
    using RowSums = IslandDirections::RowSums;
    /// The relative change that counts as float's rounding: directions would grow from it.
    static constexpr double kFloatStep = 1e-6;

    double find(int member, const RowSums& rows) {
        IslandDirections& of = of_[member];
        of.weigh(weigh(member), rows);
        double twice_energy = 0, fastest = 0;
        for (const BodySums& piece : sums_of(member, [&](Range bodies) {
                 return find_direction(group_.stage(), bodies, of.carried());
             })) {
            twice_energy += piece[0];
            fastest = std::max(fastest, piece[1]);
        }
        of.find_length(twice_energy);
        return of.length() * std::sqrt(fastest);
    }
    /// Cuts warm starts that are far more than weights: they may have ended an impact and would
    /// replay it. The part that takes the most energy stays.
    void leave_part_of_warm_starts(PerMember<double>& warm_start, Members some) {
        const ColouredStage& stage = group_.stage();
        for_all_rows(
            group_, threads_,
            [&](BatchRange batches) {
                begin_warm_start_round(stage, batches, some);
                weigh_round_step(stage, batches);
            },
            [&](BatchRange batches) {
                begin_warm_start_general(stage, batches, some);
                weigh_general_step(stage, batches);
            },
            [&](BatchRange others) {
                begin_warm_start_others(stage, others);
                weigh_others_step(stage, others);
            });
        const PerMember<RowSums> rows = sums_of_rows();
        PerMember<double> parts;
        for (const int member : some) {
            const double energy = warm_start[member];
            parts[member] = LoadWork{-rows[member].of_step, 2 * energy}.best_part();
            warm_start[member] = energy * (parts[member] * parts[member]);
        }
        leave_part_of_load(group_, threads_, parts, some);
    }
    /// Returns the bodies' part of r.z, r.p_last and the energy of a pair of sweeps.
    BodySums weigh(int member) const {
        BodySums sums = {};
        for (const BodySums& piece :
             sums_of(member, [&](Range bodies) { return weigh_step(group_.stage(), bodies); }))
            for (std::size_t k = 0; k < 3; ++k) sums[k] += piece[k];
        return sums;
    }
    /// Calls work(bodies) for pieces of an island's bodies.
    template <class Work>
    void for_bodies(int member, const Work& work) const {
        threads_.for_bodies(group_.bodies(member), work);
    }
    /// Returns the results of work(bodies) for the pieces of an island's bodies, in their order.
    template <class Work>
    std::span<const BodySums> sums_of(int member, const Work& work) const {
        const std::span<BodySums> sums = group_.body_sums(member);
        for_pieces(threads_, group_.bodies(member),
                   [&](std::size_t place, Range bodies) { sums[place] = work(bodies); });
        return sums;
    }
    /// Returns the sums of the rows of each island. They are added in the order of the batches for
    /// any number of threads.
    PerMember<RowSums> sums_of_rows() const {
        const ColouredIslands& coloured = group_.stage().step.coloured;
        PerMember<RowSums> sums;
        const auto add = [&](const auto& list, BatchRange batches) {
            for (std::uint32_t i = batches.begin; i < batches.end; ++i)
                sums[0].of_step += list[i][0], sums[0].of_all += list[i][1];
        };
        const auto add_lane = [&](int member, const std::array<Eight, 2>& lanes, std::size_t k) {
            sums[member].of_step += lanes[0].lane[k];
            sums[member].of_all += lanes[1].lane[k];
        };
        const bool shares = group_.stage().shares_batches;
        group_.for_colours(OneThread{}, LaneCount::kOne, false,
                           [&](const ColourBatches& batches, const auto&, LaneCount) {
                               if (shares) {
                                   for_lanes_of_members(coloured.round, batches.round,
                                                        coloured.round_lane_work, add_lane);
                                   for_lanes_of_members(coloured.general, batches.general,
                                                        coloured.general_lane_work, add_lane);
                               } else {
                                   add(coloured.round_work, batches.round);
                                   add(coloured.general_work, batches.general);
                                   add(coloured.others_work, batches.others);
                               }
                           });
        return sums;
    }

    const ColouredGroup& group_;
    const Threads& threads_;
    Members begun_;
    PerMember<IslandDirections> of_;
    DirectionSteps steps_;  ///< of the present pair of sweeps
};

/// Sweeps without conjugate directions.
struct NoDirections {
    template <class Work>
    double sweep_round(BatchRange batches, Sweep, Members, const Work& work) const {
        return work(batches);
    }
    template <class Work>
    double sweep_general(BatchRange batches, Sweep, Members, const Work& work) const {
        return work(batches);
    }
    template <class Work>
    double sweep_others(BatchRange some, Sweep, const Work& work) const {
        return work(some);
    }
};

}  // namespace tesserae
