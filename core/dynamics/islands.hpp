#pragma once

#include "core/dynamics/step_data.hpp"

namespace tesserae {

/// Contacts from which on an island is coloured. Fewer are solved faster by one thread, and in the
/// order of their bodies, which suits towers listed from the ground.
constexpr std::uint32_t kColouredFrom = 1024;

/// Joins the movable bodies of every contact (union-find) and sorts the contacts by island.
class IslandBuilder {
  public:
    /// step.islands from step.contacts, every one of which has a movable body.
    void build(const Simulation& simulation, StepData& step);

  private:
    BodyId root_of(BodyId id);
    void sort_by_island(const Simulation& simulation, StepData& step);
    void colour(const Simulation& simulation, StepData& step, std::size_t island);

    std::vector<BodyId> parent_;         ///< of every body; a root is its island's lowest body
    std::vector<std::uint32_t> number_;  ///< of the island whose root the body is
    std::vector<std::uint64_t> used_;    ///< colours of each body's contacts so far, a bit each
    std::vector<std::uint8_t> colour_;   ///< of each contact of the island at hand
    std::vector<std::uint32_t> sorted_;
};

}  // namespace tesserae
