// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tesserae::render {

/// A small picture that lies over a preview, where a part of it may be outside.
struct Stamp {
    int x = 0, y = 0;                ///< its upper left, in preview pixels
    int width = 0, height = 0;       ///< [preview pixels]
    std::vector<std::uint8_t> rgba;  ///< sRGB, not premultiplied, row by row
};

/// Lays stamps over a picture, the first undermost.
/// @param codes      sRGB, row by row
/// @param channels   3, or 4 with an alpha that is not premultiplied
void lay_over(std::span<const Stamp> stamps, int width, int height, int channels,
              std::span<std::uint8_t> codes);

}  // namespace tesserae::render
