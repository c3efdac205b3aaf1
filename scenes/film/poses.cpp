// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/poses.hpp"

#include <algorithm>

#include "core/dynamics/motion_version.hpp"
#include "core/error.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/versions.hpp"
#include "scenes/timeline.hpp"

namespace tesserae::scenes {

Poses::Poses(const Scene& scene, const std::vector<int>& frames,
             const std::filesystem::path& trajectory)
    : before_(scene.bodies) {
    if (trajectory.empty()) return;
    trajectory_ = std::make_unique<TrajectoryReader>(trajectory);
    const TrajectoryHeader& header = trajectory_->header();
    // A trajectory of another motion version or solver shows the same scene: it is rendered as it
    // is.
    const std::string hash = scenes::motion_hash(scene.effective, header.motion_version);
    if (header.motion_hash != hash &&
        scenes::motion_hash(without_solver(header.effective), header.motion_version) != hash)
        throw InputError(fmt::format(
            "{}: is a trajectory of another motion: {}; simulate this scene, or render "
            "the one that "
            "the trajectory was made from",
            trajectory.string(), first_motion_difference(header.effective, scene.effective)));
    if (header.bodies != scene.bodies.size())
        throw InputError(fmt::format("{}: holds {} bodies, the scene has {}", trajectory.string(),
                                     header.bodies, scene.bodies.size()));
    for (std::uint64_t step : steps_needed(scene, frames))
        if (row_of(step) == trajectory_->rows())
            throw InputError(
                fmt::format("{}: step {} is not stored, but the frames asked for need it{}",
                            trajectory.string(), step, remedy(scene, step)));
    after_ = scene.bodies;
}

std::string Poses::remedy(const Scene& scene, std::uint64_t step) const {
    const TrajectoryHeader& header = trajectory_->header();
    const auto& steps = trajectory_->steps();
    if (!steps.empty() && steps.back() < step && header.last_step &&
        steps.back() < *header.last_step)
        return fmt::format(
            ": it ends at step {} of {}; the command that made it, without --frames, continues it",
            steps.back(), *header.last_step);
    return scene.camera.shutter > 0
               ? ", as an open camera.shutter may; tesserae run simulates again for it"
               : "; simulate without --store-every, or to the end";
}

std::uint64_t Poses::row_of(std::uint64_t step) const {
    const auto& steps = trajectory_->steps();
    const auto at = std::lower_bound(steps.begin(), steps.end(), step);
    return at != steps.end() && *at == step ? at - steps.begin() : trajectory_->rows();
}

bool Poses::has(std::uint64_t step) const {
    return trajectory_ && row_of(step) < trajectory_->rows();
}

int Poses::motion_version() const {
    return trajectory_ ? trajectory_->header().motion_version : kMotionVersion;
}

std::optional<Vec4> Poses::position(const FrameInstant& instant, BodyId body) const {
    if (!trajectory_) return before_.position[body];
    if (!has(instant.step)) return {};
    const Vec4 before = trajectory_->position(row_of(instant.step), body);
    if (instant.fraction == 0) return before;
    if (!has(instant.step + 1)) return {};
    const Vec4 after = trajectory_->position(row_of(instant.step + 1), body);
    return before + instant.fraction * (after - before);
}

const Bodies& Poses::at(const FrameInstant& instant) {
    if (!trajectory_) return before_;
    trajectory_->read_row(row_of(instant.step), before_);
    if (instant.fraction > 0) {
        trajectory_->read_row(row_of(instant.step + 1), after_);
        interpolate_poses(before_, after_, instant.fraction, before_);
    }
    return before_;
}

}  // namespace tesserae::scenes
