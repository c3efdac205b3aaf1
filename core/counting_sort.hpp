#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tesserae {

/// Sorts items 0 <= i < `items`, each of which takes size(i) places, by key, by counting; those of
/// one key keep their order.
/// @param keys    how many there are
/// @param key     key(i) < keys; called twice
/// @param size    called twice
/// @param first   becomes the first place of every key, and an end: one more than keys
/// @param put     put(i, place) takes the item to its first place
template <class Key, class Size, class Index, class Put>
void counting_sort(std::size_t items, std::size_t keys, const Key& key, const Size& size,
                   std::vector<Index>& first, const Put& put) {
    first.assign(keys + 1, 0);
    for (std::size_t i = 0; i < items; ++i) first[key(i) + 1] += static_cast<Index>(size(i));
    std::partial_sum(first.begin(), first.end(), first.begin());
    for (std::size_t i = 0; i < items; ++i) {
        Index& place = first[key(i)];
        put(i, place);
        place += static_cast<Index>(size(i));
    }
    // Filling moved each start to its key's end: shift them back.
    std::shift_right(first.begin(), first.end(), 1);
    first.front() = 0;
}

/// The same with one place for each item.
template <class Key, class Index, class Put>
void counting_sort(std::size_t items, std::size_t keys, const Key& key, std::vector<Index>& first,
                   const Put& put) {
    counting_sort(
        items, keys, key, [](std::size_t) { return 1; }, first, put);
}

}  // namespace tesserae
