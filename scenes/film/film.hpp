// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/frame.hpp"
#include "scenes/film/film_folder.hpp"
#include "scenes/process/watch.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// What filming did.
struct FilmReport {
    int rendered = 0;
    int copied = 0;  ///< from the frame before, which looks the same
    int kept = 0;    ///< there already
    int parts = 0;   ///< rendered, where only a part of each frame was asked for
    render::FrameStats stats;
    double seconds = 0;
    std::filesystem::path frames, preview;  ///< folder of the frames; the last frame's preview
};

/// Which samples of a frame were left out as infinite or no number, and the command that renders
/// the pixel of the lowest again. Empty if there are none.
std::string invalid_samples_text(const render::FrameStats& stats, const Scene& scene, int frame);

/// Which part of a frame's light paths was cut off between mirrors and in glass, and what to do.
/// Empty if it is less than a thousandth.
std::string cut_paths_text(const render::FrameStats& stats, const Scene& scene, int frame);

/// How many pixels of a frame are too bright for the file, and the command that renders the lowest
/// again. Empty if there are none.
std::string clamped_pixels_text(const render::FrameStats& stats, const Scene& scene, int frame);

/// Those of these texts that are not empty.
std::vector<std::string> picture_warnings(const render::FrameStats& stats, const Scene& scene,
                                          int frame);

/// Renders frames of a still (no trajectory) or of a trajectory into folder/frames/NAME.0000.exr
/// and folder/preview/NAME.0000.png. Frames that are already there are kept. Runs on the threads of
/// the caller's parallel::Threads.
/// @param part   of each frame, into frames/NAME.0000.KofN.tiles for join_folder(); none: all of it
/// @throws InputError   the folder holds another scene's frames that may not be replaced; the
///                      trajectory is of another motion or lacks steps that the frames need
/// @throws RunError     a file cannot be written
/// @throws Stopped      `watch` says so; finished frames are kept
FilmReport film(const Scene& scene, const std::vector<int>& frames,
                const std::filesystem::path& trajectory, const std::filesystem::path& folder,
                Replace replace, bool quiet, std::optional<render::FramePart> part = {},
                const Watch& watch = {});

}  // namespace tesserae::scenes
