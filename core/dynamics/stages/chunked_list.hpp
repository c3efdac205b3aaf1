#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/dynamics/state/step_data.hpp"

namespace tesserae {

/// A list that may be filled in parallel: each range of the input writes a list of its own, and
/// these are put together in the order of the ranges, whoever came first. Its memory is kept.
template <class Item>
class ChunkedList {
  public:
    /// Calls fill(Range, std::vector<Item>& list) for every range; `all` becomes their results.
    /// @param for_each_range   (count, grain, work): as that of Schedule
    template <class Loop, class Fill>
    void collect(const Loop& for_each_range, std::size_t count, std::size_t grain, const Fill& fill,
                 std::vector<Item>& all) {
        const std::size_t chunks = (count + grain - 1) / grain;
        if (lists_.size() < chunks) lists_.resize(chunks);
        for (std::vector<Item>& list : lists_) list.clear();
        if (chunks > 0)
            for_each_range(count, grain,
                           [&](Range range) { fill(range, lists_[range.begin / grain]); });
        begin_.assign(1, 0);
        for (std::size_t chunk = 0; chunk < chunks; ++chunk)
            begin_.push_back(begin_.back() + lists_[chunk].size());
        if (chunks > 0 && begin_.back() == lists_[0].size()) return all.swap(lists_[0]);
        // Not cleared first: what is there need not be made before it is written over.
        all.resize(begin_.back());
        for_each_range(chunks, 1, [&](Range range) {
            for (std::size_t chunk = range.begin; chunk < range.end; ++chunk)
                std::copy(lists_[chunk].begin(), lists_[chunk].end(),
                          all.begin() + static_cast<std::ptrdiff_t>(begin_[chunk]));
        });
    }

  private:
    std::vector<std::vector<Item>> lists_;
    std::vector<std::size_t> begin_;  ///< of each list in `all`, and the end
};

}  // namespace tesserae
