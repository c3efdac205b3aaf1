#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/dynamics/contacts/clearances.hpp"

namespace tesserae {

// The narrow phase, of which what hardly moves is done once for many steps: two bodies with nothing
// but flat faces that touch at a face keep their manifold until they have moved against each other
// by kKeptMotion. Until then it moves with them: its normal with the body whose face it is, each
// point with both bodies.
//
// Where it was found is state (StepMemory::kept); with that its contacts are a function of the
// bodies' state, whether the points are still there or found again after a resume.

/// Records of manifolds that are kept no more, for those found next: a settled step should not have
/// to ask for memory because a few are found anew.
class SpareManifolds {
  public:
    SpareManifolds() = default;
    /// A copy has none: no two may use one record.
    SpareManifolds(const SpareManifolds&) {}
    SpareManifolds& operator=(const SpareManifolds&) { return *this; }

    /// Before any is put or taken in a search for contacts: what was put in the last one can be
    /// taken; most of many is given back.
    /// @param manifolds   how many are kept, about
    void begin(std::size_t manifolds);
    /// Any number of threads may call the others. Takes one that its list has no place for any
    /// more, if nobody else has it.
    void put(std::shared_ptr<const KeptManifold>& manifold);
    /// One that is spare or new.
    std::shared_ptr<KeptManifold> take();

  private:
    std::vector<std::shared_ptr<KeptManifold>> list_, put_;
    std::size_t taken_ = 0, count_ = 0;  ///< from the end of `list_`; of `put_`; since begin()
};

/// Before find_kept_contacts() is called for all ranges of step.pairs.
/// @param grain   ranges begin at multiples of it
/// @param last    what the sub-step before this one kept
void begin_kept(StepData& step, std::size_t grain, const std::vector<KeptManifolds>& last,
                SpareManifolds& spare);

/// Appends the contacts of the pairs in a range to a list, and writes what they keep.
/// @param last    as in begin_kept()
/// @param lists   those of step.kept from the range's on, up to the next range's: the first is
///                filled
void find_kept_contacts(const Simulation& simulation, const StepData& step, Range pairs,
                        const std::vector<KeptManifolds>& last, std::span<KeptManifolds> lists,
                        SpareManifolds& spare, Clearances& clearances, std::vector<Contact>& list);

}  // namespace tesserae
