// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "scenes/scene.hpp"

// A folder's previews as a film that plays: NAME.mp4, by ffmpeg.
namespace tesserae::scenes {

struct MovieReport {
    std::filesystem::path file;
    std::size_t frames = 0;
    double frames_per_second = 0;
    double seconds = 0;  ///< that it took
};

/// The numbers of a folder's previews, ascending.
std::vector<int> preview_numbers(const Scene& scene, const std::filesystem::path& folder);

/// Where a folder's film is.
std::filesystem::path movie_file(const Scene& scene, const std::filesystem::path& folder);

/// Whether the film is there and shows the previews as they are now.
bool is_movie_current(const Scene& scene, const std::filesystem::path& folder);

/// ffmpeg is installed.
bool has_ffmpeg();

/// Makes the film of all previews, which may be every second frame or every tenth: it lasts as long
/// as the scene does. Frames that the folder lacks are told on standard error. A preview that is
/// missing or damaged is made again from its image. H.264 in 4:2:0 with the index in front, which
/// all players take; odd sizes are padded by a row or column of black.
/// @param scene   that of the folder
/// @throws InputError   fewer than two previews, one missing between others, damaged beside no
///                      image, of another size, or of another scene
/// @throws RunError     ffmpeg is missing or fails, or the file cannot be written
/// @throws Stopped      after a signal
MovieReport make_movie(const Scene& scene, const std::filesystem::path& folder, bool quiet);

}  // namespace tesserae::scenes
