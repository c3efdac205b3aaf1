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
/// looked at. What is kept is a hint: it decides what a step costs and never what it finds, since
/// each candidate is decided by is_pair() and all pairs are among them.
class KeptPairs {
  public:
    /// step.pairs, from step.bounds.
    void refresh(const Simulation& simulation, StepData& step);

    /// step.pairs again, from bounds that are the same, after bodies woke.
    void choose_pairs(const Simulation& simulation, StepData& step);

    /// The next step searches anew.
    void forget() { held_ = false; }

    /// How many searches there were, for tests and measurements.
    std::uint64_t searches() const { return searches_; }

  private:
    bool holds(const StepData& step) const;
    void search(const Simulation& simulation, const StepData& step);

    SortAndSweep sort_and_sweep_;
    bool held_ = false;          ///< whether there was a search that is not forgotten
    std::vector<Bounds> large_;  ///< of every body, at the last search
    PairTable candidates_;
    ChunkedList<BodyPair> lists_;
    std::uint64_t searches_ = 0;
};

}  // namespace tesserae::parallel
