// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Colours the pairs of bodies of large islands and makes batches of them. No two pairs of a colour
/// share a movable body, so that any number of threads may solve them at once and get the same
/// bits.
class Colouring {
  public:
    /// Empties step.coloured.
    void begin(const Simulation& simulation, StepData& step);
    /// Adds an island, which becomes the next coloured one.
    void add(const Simulation& simulation, StepData& step, std::size_t island);
    /// Sizes the rows of all coloured islands.
    void end(StepData& step);

  private:
    /// The contacts of two bodies, which follow each other in StepData::contacts; or another
    /// constraint.
    struct Pair {
        std::uint32_t first;  ///< the first contact, or the number in StepData::constraints
        std::uint16_t bucket;
        std::uint8_t points;  ///< 0 for another constraint
    };
    void list_pairs(const Simulation& simulation, StepData& step, std::size_t island);
    void add_pair(const Simulation& simulation, StepData& step, const ContactList::Run& run,
                  Range contacts);
    std::uint32_t place_of(const Simulation& simulation, StepData& step, BodyId id);
    int colour_of(std::uint32_t a, std::uint32_t b);
    BatchRange add_others(StepData& step, Range some) const;
    BatchRange add_batches(const StepData& step, Range pairs, std::uint32_t& rows,
                           std::vector<Batch>& batches) const;

    std::vector<std::uint32_t> place_;  ///< each body's place in ColouredIslands::bodies, or 0
    std::vector<std::uint64_t> used_;  ///< colours that each of these bodies has so far, a bit each
    std::vector<Pair> pairs_;          ///< of the present island
    std::vector<std::uint32_t> order_;  ///< numbers of these pairs, by buckets
    std::vector<std::uint32_t> start_;  ///< start of each bucket in order_, and the end
};

}  // namespace tesserae
