#pragma once

#include "core/dynamics/constants.hpp"
#include "core/dynamics/stages/colouring.hpp"
#include "core/dynamics/state/step_data.hpp"

namespace tesserae {

/// Joins the movable bodies of every contact (union-find) and sorts the contacts by island.
class IslandBuilder {
  public:
    /// @param coloured_from   contacts; for tests and measurements
    explicit IslandBuilder(std::uint32_t coloured_from = kColouredFrom)
        : coloured_from_(coloured_from) {}

    /// step.islands, and the rows and batches of their contacts from step.contacts, every one of
    /// which has a movable body.
    void build(const Simulation& simulation, StepData& step);

  private:
    std::uint32_t coloured_from_;
    BodyId root_of(BodyId id);
    void sort_by_island(const Simulation& simulation, StepData& step);

    std::vector<BodyId> parent_;         ///< of every body; a root is its island's lowest body
    std::vector<BodyId> member_;         ///< of every contact: a movable body of it, then its root
    std::vector<std::uint32_t> number_;  ///< of the island whose root the body is
    Colouring colouring_;
};

}  // namespace tesserae
