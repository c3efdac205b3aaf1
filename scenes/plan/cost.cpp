// SPDX-License-Identifier: Apache-2.0
#include "scenes/plan/cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "render/measure.hpp"
#include "render/picture_needs.hpp"
#include "scenes/film/coast.hpp"
#include "scenes/film/film_camera.hpp"
#include "scenes/film/mattes.hpp"
#include "scenes/film/poses.hpp"
#include "scenes/plan/rehearsal.hpp"
#include "scenes/process/scratch_folder.hpp"
#include "scenes/process/signals.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// Frames that are looked at, at most.
constexpr std::size_t kMostFrames = 8;
/// Making and syncing a trajectory costs this beside its steps, measured [s].
constexpr double kFileSeconds = 0.03;
/// The part of the time that simulating may take.
constexpr double kSimulating = 0.4;

/// Of a trajectory, or of what was rehearsed.
std::vector<TimedBodies> poses_of(const Scene& scene, const fs::path& trajectory,
                                  const std::vector<int>& frames) {
    std::vector<int> chosen;
    const std::size_t count = std::min(kMostFrames, frames.size());
    for (std::size_t i = 0; i < count; ++i)
        chosen.push_back(frames[(2 * i + 1) * frames.size() / (2 * count)]);
    Poses there(scene, chosen, trajectory);
    std::vector<TimedBodies> poses;
    for (const int frame : chosen) {
        const FrameInstant at = frame_instant(scene, frame);
        poses.push_back({at.time, there.at(at)});
    }
    return poses;
}

render::FrameCost cost_of(const Scene& scene, const TimedBodies& at, double seconds,
                          const fs::path& folder) {
    const double rate = scene.render.frames_per_second;
    FilmCamera camera(scene);
    const render::CameraDescription opening = camera.at(at.time, at.bodies);
    // How they move meanwhile and where they are a frame later: by their velocities.
    std::vector<render::ShutterMoment> path;
    const double open = scene.camera.shutter / rate;
    if (open > 0 && scene.physics) path.push_back({open, at.bodies, {}});
    for (render::ShutterMoment& moment : path) {
        coast(moment.bodies, open);
        moment.camera = camera.at(at.time + open, moment.bodies);
    }
    render::Neighbour next{at.bodies, {}};
    if (scene.render.channels.motion) coast(next.bodies, 1 / rate);
    next.camera = camera.at(at.time + 1 / rate, next.bodies);
    std::optional<render::Mattes> mattes;
    if (scene.render.channels.cryptomatte) mattes = mattes_of(scene, folder);
    const render::Picture picture = {at.bodies,
                                     scene.appearance,
                                     scene.materials,
                                     opening,
                                     scene.lights,
                                     scene.render,
                                     path,
                                     static_cast<int>(at.time * rate),
                                     scene.render.channels.motion ? &next : nullptr,
                                     nullptr,
                                     mattes ? &*mattes : nullptr};
    render::FrameInfo info;
    info.scene_name = scene.name;
    return render::measure_frame(picture, info, seconds, folder, stop_requested());
}

/// Frames that show what the one before does are copied.
bool all_look_alike(const Scene& scene, const Plan& plan) {
    const render::Picture picture = {scene.bodies, scene.appearance, scene.materials,
                                     scene.camera, scene.lights,     scene.render};
    return !plan.moves && scene.camera_keys.empty() && !render::needs_of(picture).moving_noise;
}

void measure_rendering(const Scene& scene, const Plan& plan, const std::vector<TimedBodies>& poses,
                       const std::vector<int>& frames, double seconds, Cost& cost) {
    using Clock = std::chrono::steady_clock;
    const ScratchFolder folder("tesserae-plan-");
    const auto begin = Clock::now();
    // The middle first, then those between: what the time allows.
    std::map<double, render::FrameCost> seen;
    std::size_t rendered = 0, all = 0;
    for (std::size_t gap = std::bit_ceil(poses.size()); gap > 0; gap /= 2)
        for (std::size_t i = gap / 2; i < poses.size(); i += gap) {
            const double left =
                seconds - std::chrono::duration<double>(Clock::now() - begin).count();
            if (seen.contains(poses[i].time) || (!seen.empty() && left <= 0)) continue;
            const auto more = static_cast<double>(poses.size() - seen.size());
            const render::FrameCost here = cost_of(scene, poses[i], left / more, folder.path());
            rendered += here.rendered, all += here.all;
            seen.emplace(poses[i].time, here);
        }
    double bytes = 0;
    const bool alike = all_look_alike(scene, plan);
    for (const int frame : frames) {
        const double time = frame / scene.render.frames_per_second;
        auto near = seen.lower_bound(time);
        if (near == seen.end() ||
            (near != seen.begin() && time - std::prev(near)->first < near->first - time))
            --near;
        bytes += near->second.bytes;
        if (alike && frame != frames.front()) continue;
        cost.render_seconds += near->second.seconds();
        cost.render_error += near->second.error();
    }
    cost.frame_bytes = static_cast<std::uint64_t>(bytes);
    cost.measured.push_back(fmt::format("{} of {} tiles of {} frames", rendered, all, seen.size()));
}

}  // namespace

double measuring_seconds(const Scene& scene) {
    constexpr double kLeast = 0.3, kMost = 3, kOfBody = 4e-4;
    return std::min(kMost, kLeast + kOfBody * static_cast<double>(scene.bodies.size()));
}

Cost measure_cost(const Scene& scene, const Plan& plan, const fs::path& trajectory,
                  const std::vector<int>& frames, double seconds) {
    Cost cost;
    std::vector<TimedBodies> poses;
    const auto begin = std::chrono::steady_clock::now();
    if (trajectory.empty()) {
        Rehearsal rehearsal =
            rehearse(scene, plan, last_step_needed(scene, frames), kSimulating * seconds);
        if (rehearsal.steps > 0) {
            cost.simulate_seconds = rehearsal.seconds + kFileSeconds;
            cost.measured.push_back(
                fmt::format("{} of {} steps", rehearsal.taken, rehearsal.steps));
        }
        if (!rehearsal.is_whole())
            cost.guessed.push_back(
                fmt::format("steps {} to {}, as if with {:.0f} contacts each; frames from {:.3g} s "
                            "on, as if all stood still",
                            rehearsal.taken + 1, rehearsal.steps, rehearsal.contacts,
                            rehearsal.poses.back().time));
        poses = std::move(rehearsal.poses);
    } else {
        poses = poses_of(scene, trajectory, frames);
    }
    const double used =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    measure_rendering(scene, plan, poses, frames, std::max(0.0, seconds - used), cost);
    return cost;
}

}  // namespace tesserae::scenes
