// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/plan/plan.hpp"

namespace tesserae::scenes {

/// Bodies at some time.
struct TimedBodies {
    double time = 0;  ///< [s]
    Bodies bodies;
};

/// The first steps of a scene, taken to see what all of them will cost.
struct Rehearsal {
    std::uint64_t taken = 0, steps = 0;
    double seconds = 0;              ///< that all of them will take
    double contacts = 0;             ///< of a step that is still to come; guessed
    std::vector<TimedBodies> poses;  ///< some of those met, evenly spread in time; the first at 0

    bool is_whole() const { return taken == steps; }
};

/// Simulates for about `seconds`, one step at least, on the threads of the caller's
/// parallel::Threads.
/// @param steps   that all of them are, where something moves
Rehearsal rehearse(const Scene& scene, const Plan& plan, std::uint64_t steps, double seconds);

}  // namespace tesserae::scenes
