// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae::parallel {

/// Whether there is one thread, for which tasks would only cost their making.
inline bool is_alone() { return tbb::this_task_arena::max_concurrency() == 1; }

/// Calls work(Range) for pieces of at most `grain` items that cover 0 <= i < count, in parallel.
template <class Work>
void for_each_range(std::size_t count, std::size_t grain, const Work& work) {
    const std::size_t chunks = (count + grain - 1) / grain;
    const auto work_on = [&](std::size_t chunk) {
        work(Range{chunk * grain, std::min(count, (chunk + 1) * grain)});
    };
    if (!is_alone()) return tbb::parallel_for(std::size_t{0}, chunks, work_on);
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) work_on(chunk);
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
