#pragma once

#include "core/dynamics/step_data.hpp"

namespace tesserae {

/// Joins the movable bodies of every contact (union-find) and sorts the contacts by island.
class IslandBuilder {
  public:
    /// step.islands from step.contacts, every one of which has a movable body.
    void build(const Simulation& simulation, StepData& step);

  private:
    BodyId root_of(BodyId id);

    std::vector<BodyId> parent_;         ///< of every body; a root is its island's lowest body
    std::vector<std::uint32_t> number_;  ///< of the island whose root the body is
};

}  // namespace tesserae
