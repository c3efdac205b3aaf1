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

namespace tesserae {

/// The state of a load that is solved by pairs of sweeps along conjugate directions, see
/// conjugate.hpp.
template <class Threads>
class ConjugateDirections {
  public:
    ConjugateDirections(const ColouredIsland& island, const Threads& threads)
        : island_(island), threads_(threads) {
        const ColouredStage& stage = island.stage();
        double weight = 0;
        for (const BodySums& piece : sums_of([](auto... of) { return weigh_warm_start(of...); }))
            warm_start_ += piece[0], weight += piece[1];
        if (warm_start_ > kWarmStartWeight * weight) leave_part_of_warm_start();
        rounding_ = kFloatStep * kFloatStep * warm_start_;
        for_all_rows(
            island, threads, [&](BatchRange some) { take_warm_start_round(stage, some); },
            [&](BatchRange some) { take_warm_start_general(stage, some); },
            [&](BatchRange some) { others_of(stage, some).take_warm_start(); });
        for_bodies([](auto... of) { add_changes(of...); });
        for_bodies([](auto... of) { take_warm_start(of...); });
        for_bodies([](auto... of) { begin_directions(of...); });
    }
    /// Finds the direction after a pair of sweeps.
    /// @return the largest change of a body's velocity by a step along it [m/s]
    double find() {
        BodySums sums = weigh();  // r.z, r.p_last and the energy
        rounding_ = std::max(rounding_, kFloatStep * kFloatStep * sums[2]);
        const auto [of_step, of_all] = work();
        sums[0] += of_step, sums[1] += of_direction_, sums[2] += of_all;
        const double ratio = last_slope_ > 0 ? sums[0] / last_slope_ : 0;
        look_for_rise(ratio, sums[0], sums[2]);
        carried_ = ratio > 0 && plain_ == 0 ? static_cast<float>(ratio) : 0;
        of_direction_ = of_step + carried_ * of_direction_;
        double twice_energy = 0, fastest = 0;
        const auto find = [this](auto... of) { return find_direction(of..., carried_); };
        for (const BodySums& piece : sums_of(find)) {
            twice_energy += piece[0];
            fastest = std::max(fastest, piece[1]);
        }
        const double length = (sums[0] + carried_ * sums[1]) / twice_energy;
        holds_ = plain_ == 0 && length > 1 && sums[0] > rounding_;
        length_ = holds_ ? static_cast<float>(std::min(length, kLongestStep)) : 1;
        slope_ = sums[0];
        return length_ * std::sqrt(fastest);
    }
    /// Returns whether the next pair of sweeps begins with a step along the direction.
    bool holds() const { return holds_; }
    /// Begins the next pair of sweeps.
    void go_on() {
        last_slope_ = holds_ ? slope_ : 0;
        if (holds_) return for_bodies([this](auto... of) { go_along(of..., length_); });
        plain_ = std::max(0, plain_ - 1);
        of_direction_ = 0;
        least_slope_ = std::numeric_limits<double>::infinity();
        for_bodies([](auto... of) { begin_directions(of...); });
    }

    /// Returns, after the last pair, whether all impulses together with the warm start leave more
    /// energy than none would.
    bool is_gain() const { return weigh()[2] + work()[1] - warm_start_ > 0; }
    /// Takes the warm start back: no impulses have acted then.
    void take_back() const {
        for_bodies([](auto... of) { take_warm_start_back(of...); });
    }

    // The rows' part of a pair of sweeps. It is done batch by batch as they are swept, while they
    // are in the caches.
    /// Sweeps batches of round pairs, with their part of the directions.
    /// @param work   sweeps batches and returns their residual
    template <class Work>
    double sweep_round(BatchRange batches, Sweep sweep, const Work& work) const {
        const ColouredStage& stage = island_.stage();
        const std::vector<Batch>& all = stage.step.coloured.round;
        return largest_of_twos(all, batches, sweep.backward, [&](BatchRange some) {
            if (sweep.backward && holds_) go_along_round(stage, some, carried_, length_);
            if (sweep.backward && !holds_) begin_round_directions(stage, some);
            const double left = work(some);
            if (!sweep.backward) weigh_round_step(stage, some);
            return left;
        });
    }
    /// Sweeps batches of all other pairs, with their part of the directions.
    template <class Work>
    double sweep_general(BatchRange batches, Sweep sweep, const Work& work) const {
        const ColouredStage& stage = island_.stage();
        const std::vector<Batch>& all = stage.step.coloured.general;
        return largest_of_twos(all, batches, sweep.backward, [&](BatchRange some) {
            if (sweep.backward && holds_) go_along_general(stage, some, carried_, length_);
            if (sweep.backward && !holds_) begin_general_directions(stage, some);
            const double left = work(some);
            if (!sweep.backward) weigh_general_step(stage, some);
            return left;
        });
    }
    /// Sweeps constraints that are no contacts, with their part of the directions.
    template <class Work>
    double sweep_others(BatchRange some, Sweep sweep, const Work& work) const {
        const ColouredStage& stage = island_.stage();
        if (sweep.backward && holds_) go_along_others(stage, some, carried_, length_);
        if (sweep.backward && !holds_) begin_others_directions(stage, some);
        const double left = work(some);
        if (!sweep.backward) weigh_others_step(stage, some);
        return left;
    }

  private:
    /// The relative change that counts as float's rounding, as a part of the warm start or of all
    /// changes: directions would grow from it.
    static constexpr double kFloatStep = 1e-6;
    /// The growth of the slope over the least since directions began, at which they are given up
    /// for a while, as a factor. Usual 16. More: where float resolves no more, directions are
    /// rounding, grow from step to step, and lead impulses and velocities apart. Less: useful
    /// directions are given up.
    static constexpr double kMostRisen = 16;

    /// Cuts a warm start that is far more than weights: it may have ended an impact and would
    /// replay it. The part that takes the most energy stays.
    void leave_part_of_warm_start() {
        const ColouredStage& stage = island_.stage();
        for_all_rows(
            island_, threads_,
            [&](BatchRange some) {
                begin_warm_start_round(stage, some);
                weigh_round_step(stage, some);
            },
            [&](BatchRange some) {
                begin_warm_start_general(stage, some);
                weigh_general_step(stage, some);
            },
            [&](BatchRange some) {
                begin_warm_start_others(stage, some);
                weigh_others_step(stage, some);
            });
        const double part = LoadWork{-work()[0], 2 * warm_start_}.best_part();
        leave_part_of_load(island_, threads_, part);
        warm_start_ *= part * part;
    }
    /// Returns the bodies' part of r.z, r.p_last and the energy of a pair of sweeps.
    BodySums weigh() const {
        BodySums sums = {};
        for (const BodySums& piece : sums_of([](auto... of) { return weigh_step(of...); }))
            for (std::size_t k = 0; k < 3; ++k) sums[k] += piece[k];
        return sums;
    }
    /// Gives directions up for a while after a step that led away from the solution.
    /// @param ratio   r.z divided by r.z before the step
    void look_for_rise(double ratio, double slope, double energy) {
        const bool rises = ratio > kMostCarried || slope > kMostRisen * least_slope_;
        if (last_slope_ > 0 && !(energy <= last_energy_ && !rises)) {
            plain_ = pause_;
            pause_ = 2 * pause_;
        }
        last_energy_ = energy;
        least_slope_ = std::min(least_slope_, slope);
    }
    /// Calls work(stage, bodies) for pieces of the island's bodies.
    template <class Work>
    void for_bodies(const Work& work) const {
        threads_.for_bodies(island_.bodies(), [&](Range bodies) { work(island_.stage(), bodies); });
    }
    /// Returns the results of work(stage, bodies) for the pieces of the bodies, in their order.
    template <class Work>
    std::span<const BodySums> sums_of(const Work& work) const {
        const std::span<BodySums> sums = island_.body_sums();
        for_pieces(threads_, island_.bodies(), [&](std::size_t place, Range bodies) {
            sums[place] = work(island_.stage(), bodies);
        });
        return sums;
    }
    /// Returns the sums of round_work, general_work and others_work. They are added in the order of
    /// the batches for any number of threads.
    std::array<double, 2> work() const {
        const ColouredIslands& coloured = island_.stage().step.coloured;
        std::array<double, 2> sums = {};
        const auto add = [&](const auto& list, BatchRange batches) {
            for (std::uint32_t i = batches.begin; i < batches.end; ++i)
                for (std::size_t k = 0; k < 2; ++k) sums[k] += list[i][k];
        };
        island_.for_colours(OneThread{}, LaneCount::kOne, false,
                            [&](const ColourBatches& batches, const auto&, LaneCount) {
                                add(coloured.round_work, batches.round);
                                add(coloured.general_work, batches.general);
                                add(coloured.others_work, batches.others);
                            });
        return sums;
    }

    const ColouredIsland& island_;
    const Threads& threads_;
    double warm_start_ = 0;              ///< energy of the warm start, see weigh_warm_start()
    double slope_ = 0, last_slope_ = 0;  ///< r.z
    double least_slope_ = std::numeric_limits<double>::infinity();  ///< since a first direction
    double of_direction_ = 0;                                       ///< rows' part of r.p
    double last_energy_ = 0;                                        ///< at the end of the last pair
    double rounding_ = 0;                                           ///< rounding of a slope
    int plain_ = 0, pause_ = 1;  ///< pairs without a direction, now and the next time
    float carried_ = 0, length_ = 1;
    bool holds_ = false;  ///< see holds()
};

/// Sweeps without conjugate directions.
struct NoDirections {
    template <class Work>
    double sweep_round(BatchRange batches, Sweep, const Work& work) const {
        return work(batches);
    }
    template <class Work>
    double sweep_general(BatchRange batches, Sweep, const Work& work) const {
        return work(batches);
    }
    template <class Work>
    double sweep_others(BatchRange some, Sweep, const Work& work) const {
        return work(some);
    }
};

}  // namespace tesserae
