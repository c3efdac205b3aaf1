// SPDX-License-Identifier: Apache-2.0
#include "parallel/pair_table.hpp"

#include <limits>

namespace tesserae::parallel {

void replace_pairs(const std::vector<std::uint8_t>& moved, const std::vector<BodyPair>& found,
                   PairTable& pairs, PairTable& spare) {
    spare.first.clear(), spare.second.clear();
    auto next = found.begin();
    for (BodyId a = 0; a + 1 < pairs.first.size(); ++a) {
        spare.first.push_back(spare.second.size());
        const auto take_found = [&](BodyId before) {
            for (; next != found.end() && next->a == a && next->b < before; ++next)
                spare.second.push_back(next->b);
        };
        for (std::size_t i = pairs.first[a]; i < pairs.first[a + 1]; ++i) {
            const BodyId b = pairs.second[i];
            if (moved[a] || moved[b]) continue;
            take_found(b);
            spare.second.push_back(b);
        }
        take_found(std::numeric_limits<BodyId>::max());
    }
    spare.first.push_back(spare.second.size());
    pairs.first.swap(spare.first), pairs.second.swap(spare.second);
}

}  // namespace tesserae::parallel
