// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/dynamics/contacts/chunked_list.hpp"
#include "core/dynamics/motion/free_path.hpp"
#include "core/dynamics/step/schedule.hpp"

namespace tesserae {

/// Keeps fast bodies from passing through others in a half of a sub-step.
///
/// Contacts are found in the middle of a sub-step, where a fast body may be beyond what it has hit.
/// A pair that would pass is stopped where it first touches; both bodies lose the rest of the half,
/// until LostTime gives it back to them.
/// A stopped body may get in the way of others or no longer reach them. So impacts are taken in the
/// order of their times, and the pairs of a stopped body are looked at again.
///
/// What this costs is bounded: where so many bodies are so fast that it would take many steps'
/// time, they are stopped at times until which they surely do not touch.
class FastBodies {
  public:
    enum class Half { kFirst, kSecond };

    /// Moves bodies that have to stop back to where they stop. Their energy stays: speeds are
    /// changed by the work of gravity on the way that is lost.
    /// @param step   as after the half; step.pairs are all bodies that meet in it
    void stop(const Simulation& simulation, StepData& step, Schedule& schedule, Half half);

    /// Does the same once bodies have moved for times of their own, on which no gravity acts.
    /// @param moved   of every body [s]
    void stop(const Simulation& simulation, StepData& step, Schedule& schedule,
              std::span<const double> moved);

    /// Returns the bodies that the last call has stopped, and how long one of them moved before
    /// [s].
    std::span<const BodyId> stopped() const { return stopped_; }
    double moved_for(BodyId id) const { return stop_[id]; }

    /// Returns of how many poses of two bodies the last call has found the gap.
    std::size_t gaps() const;
    /// Returns of how many it finds the gap, about, before bodies are stopped earlier than need be.
    std::size_t most_gaps() const;

  private:
    /// Two bodies of which one is fast.
    struct Candidate {
        BodyId a, b;
        double time;  ///< time of their impact [s], or kNoImpact
    };
    struct Impact {
        double time;
        std::uint32_t candidate;
    };

    void find_stops(const Simulation& simulation, StepData& step, Schedule& schedule,
                    std::span<const double> moved, double duration);
    void put_back(const Simulation& simulation, StepData& step, BodyId id);
    FreePath new_path(const Simulation& simulation, const StepData& step, BodyId id) const;
    void find_candidates(const Simulation& simulation, const StepData& step, Schedule& schedule);
    void find_paths(const Simulation& simulation, const StepData& step, Schedule& schedule);
    void find_impacts(Schedule& schedule);
    void list_impacts();
    void take_impacts(const Simulation& simulation, const StepData& step, const Schedule& schedule);
    void stop_at(const Simulation& simulation, const StepData& step, BodyId id, double time);
    void stop_all(const Simulation& simulation, const StepData& step, double time);
    FreePath& path_of(BodyId id) { return *paths_[place_[id]]; }

    std::span<const double> moved_;       ///< of every body [s]; empty: all of the duration
    double duration_ = 0;                 ///< of the paths [s]
    std::vector<std::uint8_t> is_fast_;   ///< of every body
    std::vector<double> stop_;            ///< time at which every body stops [s], or kNoImpact
    std::vector<ImpactSearch> searches_;  ///< one for every range of pairs
    ChunkedList<Candidate> lists_;
    std::vector<Candidate> candidates_;           ///< ascending (a, b)
    std::vector<BodyId> listed_;                  ///< bodies of candidates, ascending
    std::vector<std::uint32_t> place_;            ///< of every body, in listed_
    std::vector<std::optional<FreePath>> paths_;  ///< of each of listed_
    std::vector<std::uint32_t> met_;        ///< candidates of each of listed_ in turn, ascending
    std::vector<std::uint32_t> first_met_;  ///< in met_, of each of listed_, and the end
    std::vector<Impact> fast_bodies_;       ///< a heap, the next first
    std::vector<BodyId> stopped_;
};

}  // namespace tesserae
