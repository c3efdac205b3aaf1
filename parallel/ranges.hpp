#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "core/dynamics/state/step_data.hpp"

namespace tesserae::parallel {

/// Calls work(Range) for pieces of at most `grain` items that cover 0 <= i < count, in parallel.
template <class Work>
void for_each_range(std::size_t count, std::size_t grain, const Work& work) {
    const std::size_t chunks = (count + grain - 1) / grain;
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t chunk) {
        work(Range{chunk * grain, std::min(count, (chunk + 1) * grain)});
    });
}

/// The same as an argument.
inline constexpr auto kInRanges = [](std::size_t count, std::size_t grain, const auto& work) {
    for_each_range(count, grain, work);
};

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

}  // namespace tesserae::parallel
