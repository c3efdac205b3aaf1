#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/dynamics/step/room.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// A list that may be filled in parallel: each range of the input writes a list of its own, and
/// these are put together in the order of the ranges, whoever came first. Its memory is kept.
///
/// It is filled in a few waves, so that what is held twice is a part of the whole.
template <class Item>
class ChunkedList {
  public:
    /// Calls fill(Range, std::vector<Item>& list) for every range; `all` becomes their results. It
    /// should be those of the last time, or as many.
    /// @param for_each_range   (count, grain, work): as that of Schedule
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

    /// The same for any list.
    /// @param append   (lists, ratio): puts lists behind what there is already; ratio is about that
    ///                 of all items to those that there will be then
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

    /// Gives its memory back.
    void release() { std::vector<std::vector<Item>>().swap(lists_); }

  private:
    /// Ranges and items of the input that are worked on at once, at least, and how often it is
    /// done, about: more waves take less memory, and threads wait for each other at the end of
    /// each.
    static constexpr std::size_t kChunks = 8, kItems = 4096, kWaves = 32;

    std::vector<std::vector<Item>> lists_;
    std::vector<std::size_t> begin_;  ///< of each list in `all`, and the end
};

}  // namespace tesserae
