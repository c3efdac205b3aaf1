// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/farm/request.hpp"
#include "scenes/plan/plan.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// What a film asks of a scheduler: estimates with a margin, and what follows for its tasks.
struct FarmEstimate {
    int cores = 1;                 ///< of a task
    double frame_seconds = 0;      ///< of a frame on those cores, without the margin
    double simulate_seconds = 0;   ///< the same of simulating
    int chunk = 1;                 ///< frames of a task
    int frame_minutes = 0;         ///< time limit of a task, with the margin
    int simulate_minutes = 0;      ///< the same of simulating
    std::uint64_t memory_mib = 0;  ///< of a task, with the margin
};

/// What a frame takes [s] on one core, without a margin: from its view rays alone.
double frame_core_seconds(const Scene& scene);

/// @param frames   that will be rendered
FarmEstimate estimate_farm(const Scene& scene, std::size_t frames, const FarmRequest& request);

/// The frames of each task, in the form of --frames: "0-4", "5-9", ...
std::vector<std::string> divide_frames(const std::vector<int>& frames, int chunk);

}  // namespace tesserae::scenes
