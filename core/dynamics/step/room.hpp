#pragma once

#include <cstddef>
#include <vector>

namespace tesserae {

/// What lists of a step take beyond what they need when they grow: one part in so many. Numbers of
/// contacts creep up while bodies settle, and each growth writes all of a list to new memory.
constexpr std::size_t kSpareParts = 32;
/// A list that uses less than one part in so many of its memory gives it back, unless it has less
/// than so many bytes.
constexpr std::size_t kIdleParts = 4, kLeastIdle = std::size_t{1} << 16;

/// Makes an empty list with memory for so many items. It never holds old and new memory at once,
/// as a vector that grows does.
template <class Item>
void reserve_anew(std::vector<Item>& list, std::size_t size) {
    list.clear();
    const std::size_t capacity = list.capacity();
    const bool idle = capacity > kLeastIdle / sizeof(Item) && capacity / kIdleParts > size;
    if (capacity >= size && !idle) return;
    std::vector<Item>().swap(list);
    list.reserve(size + size / kSpareParts);
}

/// Makes a list of so many items, each of which is then written: what they were may be lost.
template <class Item>
void resize_anew(std::vector<Item>& list, std::size_t size) {
    // Not cleared where they fit: what is there need not be made before it is written over.
    if (list.capacity() < size || list.capacity() / kIdleParts > size) reserve_anew(list, size);
    list.resize(size);
}

/// Gives the memory back of a list that is seldom as long, unless it has little.
template <class Item>
void release(std::vector<Item>& list) {
    list.clear();
    if (list.capacity() > kLeastIdle / sizeof(Item)) std::vector<Item>().swap(list);
}

/// Before a list is filled anew with about as many items as it had: memory for these. What they
/// were may be lost.
template <class Item>
void prepare(std::vector<Item>& list, std::size_t size) {
    size += size / (2 * kSpareParts);
    if (list.capacity() < size || list.capacity() / kIdleParts > size) reserve_anew(list, size);
}

/// Makes a list of at least `size` items, of which the first `used` stay.
/// @param ratio   of all items that are expected to so many
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
