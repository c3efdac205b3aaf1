// SPDX-License-Identifier: Apache-2.0
#include "render/file/stamp.hpp"

#include <algorithm>
#include <cstddef>

namespace tesserae::render {
namespace {

std::size_t at(int x, int y, int width) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
}

/// Lays a colour with an alpha over a pixel with one, both not premultiplied.
void lay_over(const std::uint8_t* over, int channels, std::uint8_t* pixel) {
    const int alpha = over[3], behind = channels == 4 ? pixel[3] : 255;
    // 255 times the alpha of both together.
    const int all = 255 * alpha + (255 - alpha) * behind;
    if (all == 0) return;
    for (int i = 0; i < 3; ++i)
        pixel[i] = static_cast<std::uint8_t>(
            (255 * alpha * over[i] + (255 - alpha) * behind * pixel[i] + all / 2) / all);
    if (channels == 4) pixel[3] = static_cast<std::uint8_t>((all + 127) / 255);
}

}  // namespace

void lay_over(std::span<const Stamp> stamps, int width, int height, int channels,
              std::span<std::uint8_t> codes) {
    for (const Stamp& stamp : stamps)
        for (int y = std::max(0, stamp.y); y < std::min(height, stamp.y + stamp.height); ++y)
            for (int x = std::max(0, stamp.x); x < std::min(width, stamp.x + stamp.width); ++x)
                lay_over(&stamp.rgba[4 * at(x - stamp.x, y - stamp.y, stamp.width)], channels,
                         &codes[static_cast<std::size_t>(channels) * at(x, y, width)]);
}

}  // namespace tesserae::render
