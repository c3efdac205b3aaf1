// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>

#include "core/dynamics/step/step_data.hpp"
#include "core/stop.hpp"

namespace tesserae::parallel {

/// Whether there is one thread, for which tasks would only cost their making.
inline bool is_alone() { return tbb::this_task_arena::max_concurrency() == 1; }

/// Loops over ranges in parallel, which may be ended amid the work.
class Ranges {
  public:
    /// @param stop   is asked before each piece, where there are several; null: nothing is
    explicit Ranges(const StopQuestion* stop = nullptr) : stop_(stop) {}

    /// Calls work(Range) for pieces of at most `grain` items that cover 0 <= i < count, in
    /// parallel.
    /// @throws Stopped   the work is to end
    template <class Work>
    void for_each(std::size_t count, std::size_t grain, const Work& work) const {
        const std::size_t chunks = (count + grain - 1) / grain;
        const auto work_on = [&](std::size_t chunk) {
            if (chunks > 1) look_for_stop();
            work(Range{chunk * grain, std::min(count, (chunk + 1) * grain)});
        };
        if (!is_alone()) return tbb::parallel_for(std::size_t{0}, chunks, work_on);
        for (std::size_t chunk = 0; chunk < chunks; ++chunk) work_on(chunk);
    }
    /// The same, for who takes a loop as an argument.
    template <class Work>
    void operator()(std::size_t count, std::size_t grain, const Work& work) const {
        for_each(count, grain, work);
    }

    /// Whether test(Range) is true of any such piece; those that come late are not asked once one
    /// is.
    template <class Test>
    bool any(std::size_t count, std::size_t grain, const Test& test) const {
        std::atomic<bool> any = false;
        for_each(count, grain, [&](Range range) {
            if (!any.load(std::memory_order_relaxed) && test(range))
                any.store(true, std::memory_order_relaxed);
        });
        return any;
    }

    /// @throws Stopped   the work is to end
    void look_for_stop() const { tesserae::look_for_stop(stop_); }

  private:
    const StopQuestion* stop_;
};

}  // namespace tesserae::parallel
