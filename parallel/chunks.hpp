#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <vector>

#include "core/dynamics/step_data.hpp"

namespace tesserae::parallel {

/// Calls work(Range) for pieces of at most `grain` items that cover 0 <= i < count, in parallel.
template <class Work>
void for_each_range(std::size_t count, std::size_t grain, const Work& work) {
    const std::size_t chunks = (count + grain - 1) / grain;
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        work(Range{chunk * grain, std::min(count, (chunk + 1) * grain)});
    });
}

/// Whether test(Range) is true of any such piece; those that come late are not asked once one is.
template <class Test>
bool any_range(std::size_t count, std::size_t grain, const Test& test) {
    std::atomic<bool> any = false;
    for_each_range(count, grain, [&](Range range) {
        if (!any.load(std::memory_order_relaxed) && test(range))
            any.store(true, std::memory_order_relaxed);
    });
    return any;
}

/// A list that is filled in parallel: each piece of the input writes a list of its own, and these
/// are put together in the order of the pieces, whoever came first. Its memory is kept.
template <class Item>
class ChunkedList {
  public:
    /// Calls fill(Range, std::vector<Item>& list) for each piece; `all` becomes their results.
    template <class Fill>
    void collect(std::size_t count, std::size_t grain, const Fill& fill, std::vector<Item>& all) {
        const std::size_t chunks = (count + grain - 1) / grain;
        if (lists_.size() < chunks) lists_.resize(chunks);
        for_each_range(count, grain, [&](Range range) {
            std::vector<Item>& list = lists_[range.begin / grain];
            list.clear();
            fill(range, list);
        });
        begin_.assign(1, 0);
        for (std::size_t chunk = 0; chunk < chunks; ++chunk)
            begin_.push_back(begin_.back() + lists_[chunk].size());
        // Not cleared first: what is there need not be made before it is written over.
        all.resize(begin_.back());
        for_each_range(chunks, 1, [&](Range range) {
            const std::size_t chunk = range.begin;
            std::copy(lists_[chunk].begin(), lists_[chunk].end(),
                      all.begin() + static_cast<std::ptrdiff_t>(begin_[chunk]));
        });
    }

  private:
    std::vector<std::vector<Item>> lists_;
    std::vector<std::size_t> begin_;  ///< of each list in `all`, and the end
};

}  // namespace tesserae::parallel
