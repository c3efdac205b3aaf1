#pragma once

#include <atomic>
#include <filesystem>

#include "render/picture.hpp"

namespace tesserae::render {

/// Renders one frame into the EXR file `exr` and, unless empty, the PNG file `preview`. Runs on the
/// threads of the caller's task arena; the bytes do not depend on their number.
/// @throws RunError   a file cannot be written; Stopped once `stop` is set (nothing is left under a
///                    final name); InputError for a camera without an orthonormal frame
FrameStats render_frame(const Picture& picture, const FrameInfo& info,
                        const std::filesystem::path& exr, const std::filesystem::path& preview,
                        const std::atomic<bool>& stop);

}  // namespace tesserae::render
