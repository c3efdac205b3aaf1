// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Solves impacts of large islands among the contacts near them, in double, as small islands are
/// solved. Most impacts concern a few contacts only: in a settled heap of 10^4 spheres, one or two
/// fall into a gap in every step. The rest of the island is not touched, unless an impact reaches
/// out of its patch: then the whole island is solved.
class ImpactPatches {
  public:
    /// Adds the patches to step.islands, behind the others, with rows of their own.
    /// @param hits   the contacts that are impacts
    void begin(const Simulation& simulation, StepData& step,
               std::span<const std::vector<std::uint32_t>> hits);
    /// Removes the patches from step.islands once they are solved.
    /// @return whether islands remain whose impacts have to be solved as a whole, see
    /// StepData::awaits
    bool end(const Simulation& simulation, StepData& step);

  private:
    /// The patches of one island.
    struct Patched {
        std::size_t island;
        Range motions, rim, runs;  ///< in motions_, rim_ and step.islands.runs
    };
    struct Motion {
        BodyId id;
        BodyMotion motion;
    };
    /// A run of contacts of two bodies in a patch.
    struct Pair {
        std::uint32_t patch, run;

        friend auto operator<=>(const Pair&, const Pair&) = default;
    };

    void add_patches(StepData& step, std::size_t island);
    std::size_t mark_hit(const StepData& step, Range bodies);
    void widen(const StepData& step, std::size_t place);
    std::size_t join(const StepData& step, std::size_t place);
    void add_island(StepData& step, std::span<const Pair> pairs);
    bool reaches_out(const Simulation& simulation, const StepData& step,
                     const Patched& patched) const;
    void give_up(StepData& step, const Patched& patched) const;
    std::uint32_t root_of(std::uint32_t place);

    std::vector<std::uint8_t> hit_;          ///< of every body
    std::vector<std::uint8_t> near_, next_;  ///< of every place in ColouredIslands::bodies
    std::vector<std::uint32_t> parent_;      ///< of every such place; a root is a patch
    std::vector<Pair> pairs_;
    std::vector<std::uint32_t> rim_;  ///< contacts between a body in a patch and one outside
    std::vector<Motion> motions_;     ///< motion of the bodies in patches before the impact
    std::vector<Patched> patched_;
    std::size_t islands_ = 0, runs_ = 0;  ///< their numbers without the patches
    std::size_t rows_ = 0;                ///< number with the patches
};

}  // namespace tesserae
