#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Impacts of large islands, of which they concern a few contacts only: in a heap of 10^4 spheres
/// that has settled one or two fall into a gap in every step. They are solved among the contacts
/// near them, in double, as small islands are, and the rest of the island sees nothing of them
/// unless they reach out of there: then it is solved as a whole.
class ImpactPatches {
  public:
    /// Adds them to step.islands, behind the others, with rows of their own.
    /// @param hits   contacts that are impacts
    void begin(const Simulation& simulation, StepData& step,
               std::span<const std::vector<std::uint32_t>> hits);
    /// Takes them from there again once they are solved.
    /// @return whether impacts of other islands remain to be solved, see StepData::awaits
    bool end(const Simulation& simulation, StepData& step);

  private:
    /// Of one island.
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
    std::vector<std::uint32_t> parent_;      ///< likewise; a root is a patch
    std::vector<Pair> pairs_;
    std::vector<std::uint32_t> rim_;  ///< contacts of a body that is in a patch and one that is not
    std::vector<Motion> motions_;     ///< before the impact, of the bodies in patches
    std::vector<Patched> patched_;
    std::size_t islands_ = 0, runs_ = 0;  ///< without the patches
    std::size_t rows_ = 0;                ///< with them
};

}  // namespace tesserae
