// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// What a page was made of.
struct ViewReport {
    std::size_t bodies = 0;   ///< in the page
    std::size_t moments = 0;  ///< stored for each of them
    std::uint64_t bytes = 0;  ///< of the page
    double seconds = 0;
};

/// The most bytes of poses that a page holds: with base64 and the browser's own copies several
/// times as much memory.
constexpr std::uint64_t kMostPoseBytes = 192'000'000;

struct ViewOptions {
    std::vector<int> frames;  ///< that the page shows; empty: all
    /// Leaves out bodies that never come as near as this to the film's slice [m].
    std::optional<double> near_slice;
    std::uint64_t most_pose_bytes = kMostPoseBytes;
    bool quiet = false;
};

/// Checks that `file` may be written: it ends in .html, and there is nothing, or a page that was
/// made by write_view(), which takes seconds to make again.
/// @throws InputError   else, unless `overwrite`
void require_page(const std::filesystem::path& file, bool overwrite);

/// Writes one self-contained page that shows a scene's slice at any moment: the frames that are
/// asked for, else all of the film, or where the trajectory does not have the steps for them the
/// steps that it stores.
/// @param trajectory   empty: of a scene that stands still
/// @throws InputError  the trajectory is of another motion, or lacks steps that the frames which
///                     are asked for need; more than a page can hold
/// @throws RunError    the file cannot be written
/// @throws Stopped     after a signal
ViewReport write_view(const Scene& scene, const std::filesystem::path& trajectory,
                      const std::filesystem::path& file, const ViewOptions& options);

}  // namespace tesserae::scenes
