// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace tesserae {

/// The spare memory that a step's lists take when they grow: one part in so many. Usual 32. The
/// number of contacts creeps up while bodies settle, and each growth copies a whole list to new
/// memory.
constexpr std::size_t kSpareParts = 32;
/// A list that uses less than one part in kIdleParts of its memory gives it back, unless it has
/// less than kLeastIdle bytes. Usual 4 and 64 KiB.
constexpr std::size_t kIdleParts = 4, kLeastIdle = std::size_t{1} << 16;

/// Empties a list and reserves memory for so many items. Unlike a vector that grows, it never holds
/// old and new memory at once.
template <class Item>
void reserve_anew(std::vector<Item>& list, std::size_t size) {
    list.clear();
    const std::size_t capacity = list.capacity();
    const bool idle = capacity > kLeastIdle / sizeof(Item) && capacity / kIdleParts > size;
    if (capacity >= size && !idle) return;
    std::vector<Item>().swap(list);
    list.reserve(size + size / kSpareParts);
}

/// Resizes a list to so many items. Each must then be written: their old values may be lost.
template <class Item>
void resize_anew(std::vector<Item>& list, std::size_t size) {
    // Not cleared if they fit: old items need not be created again before they are overwritten.
    if (list.capacity() < size || list.capacity() / kIdleParts > size) reserve_anew(list, size);
    list.resize(size);
}

/// Empties a list that is seldom as long as now, and gives its memory back unless it has little.
template <class Item>
void release(std::vector<Item>& list) {
    list.clear();
    if (list.capacity() > kLeastIdle / sizeof(Item)) std::vector<Item>().swap(list);
}

/// Prepares a list that will be filled anew with about `size` items: it gets memory for these. Its
/// old items may be lost.
template <class Item>
void prepare(std::vector<Item>& list, std::size_t size) {
    size += size / (2 * kSpareParts);
    if (list.capacity() < size || list.capacity() / kIdleParts > size) reserve_anew(list, size);
}

/// Grows a list to at least `size` items, of which the first `used` stay.
/// @param ratio   number of all items that are expected, divided by `size`
template <class Item>
void grow(std::vector<Item>& list, std::size_t used, std::size_t size, double ratio) {
    if (list.capacity() < size) {
        const auto expected = static_cast<std::size_t>(ratio * static_cast<double>(size));
        if (used == 0) list.clear();
        list.resize(used);
        list.reserve(expected + expected / kSpareParts);
    }
    if (list.size() < size) list.resize(size);
}

}  // namespace tesserae
