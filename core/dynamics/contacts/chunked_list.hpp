// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/dynamics/step/room.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// A list that may be filled in parallel: each range of the input writes a list of its own, and
/// these lists are joined in the order of the ranges. Their memory is kept.
///
/// The list is filled in a few waves, so that only a part of it is in memory twice.
template <class Item>
class ChunkedList {
  public:
    /// Calls fill(Range, std::vector<Item>& list) for every range and writes all results to `all`.
    /// It is fastest if `all` has about as many items before.
    /// @param for_each_range   (count, grain, work): as Schedule::for_each_range()
    template <class Loop, class Fill>
    void collect(const Loop& for_each_range, std::size_t count, std::size_t grain, const Fill& fill,
                 std::vector<Item>& all) {
        // Not cleared first: what is there need not be made before it is written over.
        prepare(all, all.size());
        std::size_t used = 0;
        for_each_wave(for_each_range, count, grain, fill, [&](const auto& lists, double ratio) {
            begin_.assign(1, used);
            for (const std::vector<Item>& list : lists)
                begin_.push_back(begin_.back() + list.size());
            grow(all, used, begin_.back(), ratio);
            for_each_range(lists.size(), 1, [&](Range range) {
                for (std::size_t i = range.begin; i < range.end; ++i)
                    std::copy(lists[i].begin(), lists[i].end(),
                              all.begin() + static_cast<std::ptrdiff_t>(begin_[i]));
            });
            used = begin_.back();
        });
        all.resize(used);
    }

    /// Calls fill() for every range, wave by wave, and append() after each wave.
    /// @param append   (lists, ratio): appends the lists of a wave; ratio is about the number of
    ///                 all items divided by the number after this wave
    template <class Loop, class Fill, class Append>
    void for_each_wave(const Loop& for_each_range, std::size_t count, std::size_t grain,
                       const Fill& fill, const Append& append) {
        const std::size_t chunks = (count + grain - 1) / grain;
        const std::size_t wave =
            std::max({kChunks, kItems / grain, (chunks + kWaves - 1) / kWaves});
        if (lists_.size() < std::min(chunks, wave)) lists_.resize(std::min(chunks, wave));
        for (std::size_t first = 0; first < chunks; first += wave) {
            const std::size_t begin = first * grain;
            const std::size_t end = std::min(count, (first + wave) * grain);
            for (std::vector<Item>& list : lists_) list.clear();
            for_each_range(end - begin, grain, [&](Range range) {
                fill({begin + range.begin, begin + range.end}, lists_[range.begin / grain]);
            });
            append(lists_, static_cast<double>(count) / static_cast<double>(end));
        }
    }

    /// Gives the memory back.
    void release() { std::vector<std::vector<Item>>().swap(lists_); }

  private:
    /// The fewest ranges and items of the input in a wave, and the number of waves, about. Usual 8,
    /// 4096 and 32. More waves take less memory, but threads wait for each other at the end of
    /// each.
    static constexpr std::size_t kChunks = 8, kItems = 4096, kWaves = 32;

    std::vector<std::vector<Item>> lists_;
    std::vector<std::size_t> begin_;  ///< each list's place in `all`, and the end
};

}  // namespace tesserae
