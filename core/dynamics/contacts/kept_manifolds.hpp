// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/dynamics/contacts/clearances.hpp"

namespace tesserae {

// The narrow phase, with manifolds that are kept over many steps. Two bodies with flat faces only
// that touch at a face keep their manifold until they have moved relative to each other by
// kKeptMotion. Until then it moves with them: its normal with the body whose face it is, each point
// with both bodies.
//
// The poses at which a manifold was found are state (StepMemory::kept). With them its contacts are
// a function of the bodies' state, whether the points are still there or are found again after a
// resume.

/// Records of manifolds that are no longer kept, for use by new ones: a settled step should not
/// allocate memory because a few are found anew.
class SpareManifolds {
  public:
    SpareManifolds() = default;
    /// Makes an empty one: no two may use one record.
    SpareManifolds(const SpareManifolds&) {}
    SpareManifolds& operator=(const SpareManifolds&) { return *this; }

    /// Is called before a search for contacts: records put in the last search can be taken from now
    /// on. If there are many, most memory is given back.
    /// @param manifolds   number of kept manifolds, about
    void begin(std::size_t manifolds);
    /// Puts in a record that its list has dropped, if nobody else has it. Any number of threads may
    /// call put() and take().
    void put(std::shared_ptr<const KeptManifold>& manifold);
    /// Returns a spare record, or a new one.
    std::shared_ptr<KeptManifold> take();

  private:
    std::vector<std::shared_ptr<KeptManifold>> list_, put_;
    std::size_t taken_ = 0, count_ = 0;  ///< from the end of `list_`; of `put_`; since begin()
};

/// Is called before find_kept_contacts() is called for all ranges of step.pairs.
/// @param grain   ranges begin at multiples of it
/// @param last    the manifolds that the sub-step before this one kept
void begin_kept(StepData& step, std::size_t grain, const std::vector<KeptManifolds>& last,
                SpareManifolds& spare);

/// Appends the contacts of the pairs in a range to a list, and writes what they keep.
/// @param last    as in begin_kept()
/// @param lists   the lists of step.kept from the range's to the next range's; the first is filled
void find_kept_contacts(const Simulation& simulation, const StepData& step, Range pairs,
                        const std::vector<KeptManifolds>& last, std::span<KeptManifolds> lists,
                        SpareManifolds& spare, Clearances& clearances, std::vector<Contact>& list);

}  // namespace tesserae
