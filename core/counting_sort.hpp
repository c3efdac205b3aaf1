// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tesserae {

/// Sorts the items 0 <= i < `items` by key, by counting. Items with the same key keep their order.
/// @param keys    number of keys
/// @param key     key(i) < keys; called twice for each item
/// @param first   becomes the first place of every key, and one more entry, the end
/// @param put     put(i, place) moves item i to its place
template <class Key, class Index, class Put>
void counting_sort(std::size_t items, std::size_t keys, const Key& key, std::vector<Index>& first,
                   const Put& put) {
    first.assign(keys + 1, 0);
    for (std::size_t i = 0; i < items; ++i) ++first[key(i) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    for (std::size_t i = 0; i < items; ++i) put(i, first[key(i)]++);
    // Filling moved each start to its key's end: shift them back.
    std::shift_right(first.begin(), first.end(), 1);
    first.front() = 0;
}

}  // namespace tesserae
