// SPDX-License-Identifier: Apache-2.0
#include "scenes/farm/estimate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "render/picture_needs.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

/// Of a view ray with its shadow rays [s on one core], and of each bounce of a path: twice what the
/// gallery takes on the project's machine (bench/results). A scene may take a tenth or ten times.
constexpr double kViewRaySeconds = 2e-6, kBounceSeconds = 4e-6;
/// Of a movable body in a step [s on one core]: boxes in a pile, twice spheres.
constexpr double kBodyStepSeconds = 20e-6;
/// Cores of a task where the user names none: frames are independent, many small tasks begin
/// earlier in a full cluster than few large ones.
constexpr int kUsualCores = 4;
/// A task's time [s] where frames are short: its start-up, some tenths of a second and what the
/// scheduler takes, is below a hundredth; the last one to end makes the others wait little.
constexpr double kTaskSeconds = 300;
/// Slurm's MaxArraySize is 1001 where a site has not changed it.
constexpr std::size_t kMostTasks = 1000;
/// A time limit that is too long costs a later start, one that is too short the frame at hand.
constexpr double kTimeMargin = 8, kLeastMinutes = 15;
constexpr double kMemoryMargin = 1.5;

int minutes_of(double seconds) {
    return static_cast<int>(std::min(1e6, std::ceil(kLeastMinutes + kTimeMargin * seconds / 60)));
}

}  // namespace

double frame_core_seconds(const Scene& scene) {
    const render::Settings& r = scene.render;
    const render::Crop w = r.window();
    const double rays = static_cast<double>(w.x1 - w.x0) * (w.y1 - w.y0) *
                        static_cast<double>(render::most_view_rays(r));
    const bool is_path = r.integrator == render::Integrator::kPath;
    return rays * (kViewRaySeconds + (is_path ? r.bounces * kBounceSeconds : 0));
}

FarmEstimate estimate_farm(const Scene& scene, std::size_t frames, const FarmRequest& request) {
    FarmEstimate e;
    e.cores = request.cores > 0 ? request.cores : kUsualCores;
    const Plan plan = make_plan(scene, e.cores);
    e.frame_seconds = frame_core_seconds(scene) / e.cores;
    // Simulating is not counted on more cores: small scenes do not use them.
    e.simulate_seconds = static_cast<double>(plan.steps) *
                         static_cast<double>(plan.movable_bodies) * kBodyStepSeconds;

    const auto least = static_cast<double>((frames + kMostTasks - 1) / kMostTasks);
    const double usual = std::floor(kTaskSeconds / std::max(e.frame_seconds, 1e-6));
    e.chunk = request.chunk > 0
                  ? request.chunk
                  : static_cast<int>(std::clamp(usual, least, static_cast<double>(frames)));
    e.frame_minutes = minutes_of(e.chunk * e.frame_seconds);
    e.simulate_minutes = minutes_of(e.simulate_seconds);
    e.memory_mib = static_cast<std::uint64_t>(
        std::ceil(kMemoryMargin * static_cast<double>(plan.memory_bytes) / (1 << 20)));
    return e;
}

std::vector<std::string> divide_frames(const std::vector<int>& frames, int chunk) {
    std::vector<std::string> tasks;
    const auto size = static_cast<std::size_t>(chunk);
    for (std::size_t i = 0; i < frames.size(); i += size) {
        const std::size_t end = std::min(frames.size(), i + size);
        tasks.push_back(frames_text(std::vector<int>(frames.begin() + static_cast<long>(i),
                                                     frames.begin() + static_cast<long>(end))));
    }
    return tasks;
}

}  // namespace tesserae::scenes
