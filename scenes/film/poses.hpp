// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scenes/scene.hpp"
#include "scenes/timeline.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {

/// The bodies' poses at the instants of frames and of their shutters: those of the scene (a still),
/// or interpolated between a trajectory's stored steps, positions linearly and rotors along the
/// shortest way.
class Poses {
  public:
    /// @param frames       that will be asked for
    /// @param trajectory   empty: every frame shows the scene's own poses
    /// @throws InputError   the trajectory is of another motion or lacks a step that a frame needs
    Poses(const Scene& scene, const std::vector<int>& frames,
          const std::filesystem::path& trajectory);

    /// Valid until the next call.
    const Bodies& at(const FrameInstant& instant);

    /// Where a body is, as at() has it; none if the trajectory lacks a step for it.
    std::optional<Vec4> position(const FrameInstant& instant, BodyId body) const;

    /// A trajectory holds the step; of a shutter's it may not.
    bool has(std::uint64_t step) const;

    /// By which the trajectory was made; that of the program for a still.
    int motion_version() const;

  private:
    /// What to do about a step that is not stored.
    std::string remedy(const Scene& scene, std::uint64_t step) const;
    std::uint64_t row_of(std::uint64_t step) const;

    std::unique_ptr<TrajectoryReader> trajectory_;
    Bodies before_, after_;
};

}  // namespace tesserae::scenes
