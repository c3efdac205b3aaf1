#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/dynamics/contacts/chunked_list.hpp"
#include "core/dynamics/step/schedule.hpp"

namespace tesserae {

/// Keeps bodies from passing through each other on their way through a half of a sub-step.
///
/// Contacts are found in the middle of a sub-step, where a fast body may be beyond what it has hit.
/// A pair that would pass is stopped where it first touches; both bodies lose the rest of the half.
/// What is stopped may be in the way of others, or leave the way of none, and so the impacts are
/// taken in the order of their times, and what a stopped body may meet is looked at again.
class FastBodies {
  public:
    enum class Half { kFirst, kSecond };

    /// Moves what has to stop back to where it stops. The bodies' energy stays: gravity takes from
    /// or gives to a speed what it has not done on the way that is lost.
    /// @param step   as after the half; step.pairs: all that meet in it
    void stop(const Simulation& simulation, StepData& step, Schedule& schedule, Half half);

  private:
    /// Two bodies of which one is fast.
    struct Candidate {
        BodyId a, b;
        double time;  ///< of their impact [s], or kNoImpact
    };
    struct Impact {
        double time;
        std::uint32_t candidate;
    };

    void find_candidates(const Simulation& simulation, const StepData& step, Schedule& schedule);
    void list_impacts();
    void take_impacts(const Simulation& simulation, const StepData& step);
    void stop_body(const Simulation& simulation, const StepData& step, BodyId id, double time);
    double look_at(const Simulation& simulation, const StepData& step, const Candidate& candidate,
                   double from, std::vector<Contact>& scratch) const;

    std::vector<std::uint8_t> is_fast_;          ///< of every body
    std::vector<double> stop_;                   ///< of every body [s], or kNoImpact
    std::vector<std::vector<Contact>> scratch_;  ///< of every range of pairs
    ChunkedList<Candidate> lists_;
    std::vector<Candidate> candidates_;                  ///< ascending (a, b)
    std::vector<std::pair<BodyId, std::uint32_t>> met_;  ///< each body's candidates, ascending
    std::vector<Impact> fast_bodies_;                    ///< a heap, the next first
    std::vector<BodyId> stopped_;
};

}  // namespace tesserae
