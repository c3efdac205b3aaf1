// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/dynamics/contacts/chunked_list.hpp"
#include "core/dynamics/step/schedule.hpp"

namespace tesserae {

/// Keeps fast bodies from passing through others in a half of a sub-step.
///
/// Contacts are found in the middle of a sub-step, where a fast body may be beyond what it has hit.
/// A pair that would pass is stopped where it first touches; both bodies lose the rest of the half.
/// A stopped body may get in the way of others or no longer reach them. So impacts are taken in the
/// order of their times, and the pairs of a stopped body are looked at again.
class FastBodies {
  public:
    enum class Half { kFirst, kSecond };

    /// Moves bodies that have to stop back to where they stop. Their energy stays: speeds are
    /// changed by the work of gravity on the way that is lost.
    /// @param step   as after the half; step.pairs are all bodies that meet in it
    void stop(const Simulation& simulation, StepData& step, Schedule& schedule, Half half);

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

    void find_candidates(const Simulation& simulation, const StepData& step, Schedule& schedule);
    void list_impacts();
    void take_impacts(const Simulation& simulation, const StepData& step);
    void stop_at(const Simulation& simulation, const StepData& step, BodyId id, double time);
    double look_at(const Simulation& simulation, const StepData& step, const Candidate& candidate,
                   double from, std::vector<Contact>& scratch) const;

    std::vector<std::uint8_t> is_fast_;  ///< of every body
    std::vector<double> stop_;           ///< time at which every body stops [s], or kNoImpact
    std::vector<std::vector<Contact>> scratch_;  ///< one for every range of pairs
    ChunkedList<Candidate> lists_;
    std::vector<Candidate> candidates_;                  ///< ascending (a, b)
    std::vector<std::pair<BodyId, std::uint32_t>> met_;  ///< each body's candidates, ascending
    std::vector<Impact> fast_bodies_;                    ///< a heap, the next first
    std::vector<BodyId> stopped_;
};

}  // namespace tesserae
