// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "core/function_ref.hpp"
#include "render/finished_picture.hpp"
#include "render/picture.hpp"

namespace tesserae::render {

/// Renders one frame into the EXR file `exr` and, unless empty, the PNG file `preview`. Runs on the
/// threads of the caller's task arena; the bytes do not depend on their number.
/// @throws RunError   a file cannot be written; Stopped once `stop` is set (nothing is left under a
///                    final name); InputError for a camera without an orthonormal frame
FrameStats render_frame(const Picture& picture, const FrameInfo& info,
                        const std::filesystem::path& exr, const std::filesystem::path& preview,
                        const std::atomic<bool>& stop);

/// A frame in memory.
struct FrameInMemory {
    std::shared_ptr<tesserae::Picture::Inside> picture;
    FrameStats stats;
};

/// Renders one frame into memory: the same pixels, and the same bytes of its files once they are
/// written.
/// @param tell(done, of)   is called after each tile, by one thread at a time; it may throw Stopped
/// @throws Stopped, InputError   as render_frame()
FrameInMemory render_in_memory(const Picture& picture, const FrameInfo& info,
                               const std::atomic<bool>& stop,
                               FunctionRef<void(std::uint64_t done, std::uint64_t of)> tell);

/// Which run of a frame's tiles, in the order in which they are rendered: cut into `count` runs of
/// equal length, to one tile.
struct FramePart {
    int number = 1, count = 1;  ///< 1 <= number <= count
};

/// Renders a part of a frame into a file from which, with the others, join_parts() makes what
/// render_frame() would have made. A whole file of this part of this frame is kept, a damaged one
/// made again.
/// @return nothing if it was there
/// @throws InputError   a part of another frame is there and not `overwrite`; else as render_frame
std::optional<FrameStats> render_part(const Picture& picture, const FrameInfo& info,
                                      const FramePart& part, const std::filesystem::path& file,
                                      bool overwrite, const std::atomic<bool>& stop);

}  // namespace tesserae::render
