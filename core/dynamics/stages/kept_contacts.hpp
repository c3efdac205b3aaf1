#pragma once

#include "core/dynamics/state/step_data.hpp"

namespace tesserae {

// The narrow phase, of which what hardly moves is done once for many steps: two bodies with nothing
// but flat faces that touch at a face keep their manifold until they have moved against each other
// by kKeptMotion. Until then it moves with them: its normal with the body whose face it is, each
// point with both bodies.
//
// Where it was found is state (StepMemory::kept); with that its contacts are a function of the
// bodies' state, whether the points are still there or found again after a resume.

/// Before find_kept_contacts() is called for all ranges of step.pairs.
/// @param grain   ranges begin at multiples of it
void begin_kept(const StepData& step, std::size_t grain, std::vector<KeptManifolds>& kept);

/// Appends the contacts of the pairs in a range to a list, and writes what they keep.
/// @param last   what the sub-step before this one kept
void find_kept_contacts(const Simulation& simulation, const StepData& step, Range pairs,
                        const std::vector<KeptManifolds>& last, KeptManifolds& kept,
                        std::vector<Contact>& list);

}  // namespace tesserae
