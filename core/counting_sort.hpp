#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tesserae {

/// Sorts items 0 <= i < `items` by key, by counting; those of one key keep their order.
/// @param keys    how many there are
/// @param key     key(i) < keys; called twice
/// @param first   becomes the first place of every key, and an end: one more than keys
/// @param put     put(i, place) takes the item to its place
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
