// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae::parallel {

/// Pairs of bodies, ascending: each body's seconds are there one after the other.
struct PairTable {
    std::vector<std::size_t> first = {0};  ///< of every body's in `second`, and an end
    std::vector<BodyId> second;

    std::size_t size() const { return second.size(); }
    /// Calls visit(a, b) for some of the pairs, by their numbers.
    template <class Visit>
    void for_each(Range pairs, const Visit& visit) const {
        auto next = std::upper_bound(first.begin(), first.end(), pairs.begin);
        for (std::size_t i = pairs.begin; i < pairs.end; ++i) {
            while (*next == i) ++next;
            visit(static_cast<BodyId>(next - first.begin() - 1), second[i]);
        }
    }
};

/// Replaces the pairs of some bodies.
/// @param moved   1 for these, for every body
/// @param found   their pairs, ascending
/// @param spare   becomes the pairs as they were; its memory is used
void replace_pairs(const std::vector<std::uint8_t>& moved, const std::vector<BodyPair>& found,
                   PairTable& pairs, PairTable& spare);

}  // namespace tesserae::parallel
