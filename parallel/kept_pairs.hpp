// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/contacts/chunked_list.hpp"
#include "parallel/sort_and_sweep.hpp"

namespace tesserae::parallel {

/// The same pairs as core's test_all_pairs(), from a list of candidates that lasts for several
/// steps.
///
/// A search is made with balls that are larger than the bodies' bounds. While every body's bounds
/// lie within its larger ball, two that overlap are among the pairs then found, and only these are
/// looked at. Where few bodies leave their balls, only their pairs are searched again. What is kept
/// is a hint: it decides what a step costs and never what it finds, since each candidate is decided
/// by is_pair() and all pairs are among them.
class KeptPairs {
  public:
    KeptPairs() : lasted_(kRare) {}

    /// step.pairs, from step.bounds.
    void refresh(const Simulation& simulation, StepData& step, const Ranges& ranges = Ranges());

    /// step.pairs again, from bounds that are the same, after bodies woke.
    void choose_pairs(const Simulation& simulation, StepData& step,
                      const Ranges& ranges = Ranges());

    /// The next step searches anew.
    void forget() { held_ = false; }

    /// How many searches for all pairs there were, for tests and measurements.
    std::uint64_t searches() const { return searches_; }
    /// How many searches for the pairs of some bodies there were.
    std::uint64_t searches_for_some() const { return searches_for_some_; }

  private:
    /// A search that comes so many steps after the last one is rare.
    static constexpr int kRare = 8;

    std::size_t list_moved(const StepData& step, const Ranges& ranges);
    void enlarge(const Simulation& simulation, const StepData& step, std::size_t body);
    bool search_for_some(const Simulation& simulation, const StepData& step, const Ranges& ranges);
    void search(const Simulation& simulation, StepData& step, const Ranges& ranges);

    SortAndSweep sort_and_sweep_;
    bool held_ = false;                ///< whether there was a search that is not forgotten
    std::vector<Bounds> large_;        ///< of every body, at its last search
    std::vector<std::uint8_t> moved_;  ///< of every body: it has left its larger ball
    int lasted_;                       ///< steps since the last search, up to kRare
    PairTable candidates_;
    ChunkedList<BodyPair> lists_;
    std::uint64_t searches_ = 0, searches_for_some_ = 0;
};

}  // namespace tesserae::parallel
