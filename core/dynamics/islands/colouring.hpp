// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Colours the pairs of bodies of large islands and makes batches of them. No two pairs of a colour
/// share a movable body, so that any number of threads may solve them at once and get the same
/// bits.
class Colouring {
  public:
    /// Empties step.coloured.
    void begin(const Simulation& simulation, StepData& step);
    /// Adds a group of islands, which become the next coloured ones.
    /// @param share   whether pairs of several islands may be in a batch
    void add(const Simulation& simulation, StepData& step, std::span<const std::uint32_t> group,
             bool share);
    /// Sizes the rows of all coloured islands.
    void end(StepData& step);

  private:
    /// The contacts of two bodies, which follow each other in StepData::contacts; or another
    /// constraint.
    struct Pair {
        std::uint32_t first;  ///< the first contact, or the number in StepData::constraints
        std::uint16_t bucket;
        std::uint8_t points;  ///< 0 for another constraint
        std::uint8_t member;  ///< the island, of its group
    };
    void add_member(const Simulation& simulation, StepData& step, std::size_t island);
    void list_pairs(const Simulation& simulation, StepData& step, std::size_t island);
    void add_pair(const Simulation& simulation, StepData& step, const ContactList::Run& run,
                  Range contacts);
    std::uint32_t place_of(const Simulation& simulation, StepData& step, BodyId id);
    int colour_of(std::uint32_t a, std::uint32_t b);
    BatchRange add_others(StepData& step, Range some) const;
    BatchRange add_batches(const StepData& step, std::span<const std::uint32_t> starts,
                           std::uint32_t& rows, std::vector<Batch>& batches) const;
    void add_batch(const StepData& step, Range pairs, std::uint32_t& rows,
                   std::vector<Batch>& batches) const;

    std::vector<std::uint32_t> place_;  ///< each body's place in ColouredIslands::bodies, or 0
    std::vector<std::uint64_t> used_;  ///< colours that each of these bodies has so far, a bit each
    std::vector<Pair> pairs_;          ///< of the present group
    std::uint8_t member_ = 0;          ///< the present island, of its group
    std::vector<std::uint32_t> order_;  ///< numbers of these pairs, by buckets
    std::vector<std::uint32_t> start_;  ///< start of each bucket in order_, and the end
};

}  // namespace tesserae
