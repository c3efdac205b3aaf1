// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "render/picture.hpp"

namespace tesserae::render {

/// Where a frame's files lie.
struct FrameFiles {
    std::filesystem::path exr, preview;
};

/// render_frame() of a picture that is the same as that of another frame: its pixels are copied as
/// they are stored, the header written anew. The bytes are those of rendering it.
/// @param from              files of a frame that was rendered from a picture that is equal but
///                          for its overlay
/// @param is_same_overlay   in that too
/// @throws RunError   a file cannot be read or written
void copy_frame(const FrameFiles& from, bool is_same_overlay, const Picture& picture,
                const FrameInfo& info, const FrameFiles& to);

}  // namespace tesserae::render
