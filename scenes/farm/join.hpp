// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "render/file/copied_frame.hpp"
#include "render/frame.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// FRAMES/NAME.0000.exr to FRAMES/NAME.0000.KofN.tiles.
std::filesystem::path part_file(const std::filesystem::path& exr, const render::FramePart& part);

/// In how many parts a frame is rendered, so that who is interrupted begins one part again and not
/// the frame: 1 where it is estimated below 5 minutes of one core. A function of the scene alone.
int parts_of_frame(const Scene& scene);

/// render_part(), which says on standard error that it makes a damaged part again.
std::optional<render::FrameStats> render_one_part(const render::Picture& picture,
                                                  const render::FrameInfo& info,
                                                  const render::FramePart& part,
                                                  const std::filesystem::path& exr, bool overwrite,
                                                  const std::atomic<bool>& stop);

/// Removes those of `count` parts of a frame that a run has left that was killed amid removing
/// them.
void remove_parts(const std::filesystem::path& exr, int count);

/// render_frame() by way of `count` parts, which are its journal: those that an earlier run has
/// left are used, and all are removed once the frame is there.
render::FrameStats render_in_parts(const render::Picture& picture, const render::FrameInfo& info,
                                   const render::FrameFiles& files, int count, bool overwrite,
                                   const std::atomic<bool>& stop);

/// What joining did.
struct JoinReport {
    int joined = 0;                    ///< frames
    int removed = 0;                   ///< parts of frames that were whole already
    std::vector<std::string> missing;  ///< "NAME.0007: parts 2, 5 of 8"
    std::vector<std::string> wrong;    ///< parts that are damaged or of something else, and why
};

/// Makes whole frames and previews of the parts in DIR/frames, and removes these. Parts of frames
/// that are not all there stay, unless the frame is whole: an earlier call was killed while it
/// removed them.
/// @throws InputError   there are no frames; RunError: a file cannot be written
JoinReport join_folder(const std::filesystem::path& folder);

}  // namespace tesserae::scenes
