// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>

#include "core/error.hpp"
#include "scenes/process/signals.hpp"

namespace tesserae::scenes {

/// How others see how far work is, and end it. By itself nobody sees it, and signals end it.
struct Watch {
    const std::atomic<bool>* stop = &stop_requested();
    /// Returns whether the work goes on.
    std::function<bool(std::uint64_t done, std::uint64_t total)> progress = {};

    bool is_stopped() const { return stop->load(std::memory_order_relaxed); }
    /// @throws Stopped   the work is to end
    void look() const {
        if (is_stopped()) throw Stopped();
    }
    /// Tells how far the work is.
    /// @throws Stopped   the work is to end
    void tell(std::uint64_t done, std::uint64_t total) const {
        look();
        if (progress && !progress(done, total)) throw Stopped();
    }
};

}  // namespace tesserae::scenes
