// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cmath>
#include <filesystem>

#include "render/picture.hpp"

namespace tesserae::render {

/// What render_frame() would cost, from some of a frame's tiles.
struct FrameCost {
    double before = 0;                  ///< trees and lists [s]
    double tiles = 0;                   ///< what those cost that were measured, on all threads [s]
    double after = 0;                   ///< the preview and what a file costs beside its tiles [s]
    double bytes = 0;                   ///< of the image, all tiles
    std::size_t rendered = 0, all = 0;  ///< tiles
    double spread = 0;  ///< standard deviation of a tile's cost, as a part of its mean

    double seconds() const {
        return before + after + tiles * static_cast<double>(all) / static_cast<double>(rendered);
    }
    /// Standard error of seconds(), from how unlike each other the tiles were [s].
    double error() const {
        const auto count = static_cast<double>(rendered), whole = static_cast<double>(all);
        return spread * std::sqrt((1 - count / whole) / count) * tiles * whole / count;
    }
};

/// Renders tiles all over a frame until about `seconds` have passed, with fewer samples where there
/// are many; leaves no file. One tile a thread is rendered whatever the time.
/// @param folder   for a file meanwhile
/// @throws as render_frame()
FrameCost measure_frame(const Picture& picture, const FrameInfo& info, double seconds,
                        const std::filesystem::path& folder, const std::atomic<bool>& stop);

}  // namespace tesserae::render
