// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "core/dynamics/constants.hpp"
#include "core/dynamics/islands/colouring.hpp"
#include "core/dynamics/solver/block_cholesky.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// The numbers of contacts from which an island is coloured.
struct ColouredFrom {
    std::uint32_t held = kColouredFrom;      ///< if some body touches one that contacts do not move
    std::uint32_t unequal = 1;               ///< of these, if masses differ by kUnequalMasses
    std::uint32_t free = kFreeColouredFrom;  ///< if nothing holds the island
    /// The number of bodies with joints up to which an island is not, see JointBlock.
    std::size_t direct = BlockCholesky::kMostRows;

    ColouredFrom() = default;
    /// All islands from so many contacts on, and no JointBlock.
    ColouredFrom(std::uint32_t both)  // NOLINT: meant to convert
        : held(both), unequal(both), free(both), direct(0) {}
};

/// Joins the movable bodies of every contact and other constraint (union-find) and sorts these by
/// island.
class IslandBuilder {
  public:
    /// @param coloured_from   for tests and measurements
    explicit IslandBuilder(ColouredFrom coloured_from = {}) : coloured_from_(coloured_from) {}

    /// Builds step.islands, and the rows and batches of their contacts, from step.contacts and
    /// step.constraints. Each of them must have a movable body.
    void build(const Simulation& simulation, StepData& step);

  private:
    /// Whether the numbers of an island's bodies fit in floats.
    struct FloatRange {
        bool fits = true;                             ///< each body's, see TypeProperties
        int least = std::numeric_limits<int>::max();  ///< exponents of 2 of their masses
        int most = std::numeric_limits<int>::min();
    };

    ColouredFrom coloured_from_;
    BodyId root_of(BodyId id);
    bool is_coloured(const Islands& islands, std::size_t island) const;
    void add_coloured(const Simulation& simulation, StepData& step, std::uint32_t island);
    void add_group(const Simulation& simulation, StepData& step);
    static std::size_t pairs_if_few(const StepData& step, std::size_t island);
    BodyId join(const Simulation& simulation, BodyId a, BodyId b);
    std::uint32_t number_islands();
    void weigh_islands(const Simulation& simulation, Islands& islands);
    void sort_by_island(const Simulation& simulation, StepData& step);
    void find_direct(const Simulation& simulation, StepData& step);

    std::vector<BodyId> parent_;  ///< of every body; a root is its island's lowest body
    /// Of every run of contacts, and then of every other constraint: a movable body, then its root.
    std::vector<BodyId> member_;
    std::vector<std::uint32_t> number_;           ///< of the island whose root the body is
    std::vector<double> least_mass_, most_mass_;  ///< of every island's bodies [kg]
    std::vector<FloatRange> floats_;              ///< of every island's bodies
    std::vector<std::uint32_t> jointed_;          ///< number of each island's bodies with joints
    std::vector<std::uint8_t> is_jointed_;        ///< of every body: it is counted there
    std::vector<std::uint32_t> group_;            ///< islands that will share batches
    std::size_t pairs_of_group_ = 0;
    Colouring colouring_;
};

}  // namespace tesserae
