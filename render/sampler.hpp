#pragma once

#include <cstdint>

#include "render/camera.hpp"

namespace tesserae::render {

/// Where sample `index` of pixel (x, y) lies inside the pixel: a point of [0, 1)^2. A function of
/// its arguments alone, pixels counted from the full frame's corner, so that crop, tile size and
/// threads change nothing. The frame's number is no argument: frames of a scene at rest are the
/// same, where a new pattern each frame would make them crawl.
/// The points of a pixel are the first two Sobol dimensions, each pixel with its own Owen
/// scrambling: every 2^k x 2^(m-k) grid of equal cells holds one point of 2^m.
/// Source: Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020, listings 1 to 3; the hash
/// constants are those of its corrected listing (Vegdahl 2021).
Vec2 pixel_sample(int x, int y, std::uint32_t index);

}  // namespace tesserae::render
