// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenes/plan/plan.hpp"

namespace tesserae::scenes {

/// What the work will take, from some of it done.
struct Cost {
    double simulate_seconds = 0;
    double render_seconds = 0;
    double render_error = 0;            ///< standard error of it [s]
    std::uint64_t frame_bytes = 0;      ///< images and previews
    std::vector<std::string> measured;  ///< what was done of it, a line each
    std::vector<std::string> guessed;   ///< what could not be seen

    /// Whether the times may be wrong by more than a factor of two: something could not be seen, or
    /// the tiles that were rendered are so unlike each other that two standard errors are half of
    /// the time.
    bool is_rough() const { return !guessed.empty() || 4 * render_error > render_seconds; }
};

/// How long a plan measures [s]: half a second in all for a few bodies, some for many, whose first
/// steps tell little.
double measuring_seconds(const Scene& scene);

/// Simulates and renders for about `seconds` in memory and in a temporary folder. Runs on the
/// threads of the caller's parallel::Threads.
/// @param trajectory   where the bodies will be, if it is known; else empty
/// @param frames       that will be rendered; steps are counted to the last of them
/// @throws InputError   as Poses; RunError a body left the finite range
Cost measure_cost(const Scene& scene, const Plan& plan, const std::filesystem::path& trajectory,
                  const std::vector<int>& frames, double seconds);

}  // namespace tesserae::scenes
