// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Imath/half.h>

#include <atomic>
#include <cstdint>
#include <vector>

#include "render/tile/centre_layers.hpp"
#include "render/tile/frame_scene.hpp"
#include "render/tile/tiles.hpp"

namespace tesserae::render {

/// A pixel in the types of the image file.
struct Pixel {
    Imath::half color[3];   ///< radiance: bodies' part premultiplied by coverage, plus the sky's
    Imath::half alpha;      ///< coverage of bodies
    Imath::half albedo[3];  ///< of bodies, premultiplied by coverage
    float depth;            ///< along the ray [m]; infinite where no body is
    float normal[4];        ///< world axes
    float position[4];      ///< world [m]
    std::uint32_t id;       ///< body number + 1, 0 where no body is
    float variance[3];      ///< of the colour, as an estimate of the true mean
    std::uint32_t samples;
};

/// A finished tile: its pixels row by row.
struct TileImage {
    int column = 0, row = 0;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    std::vector<Pixel> pixels;
    std::vector<LayerPixel> layers;  ///< in the same order; empty where no channel is of them
    std::vector<MattePixel> mattes;  ///< the same
    FrameStats stats;

    int width() const { return x1 - x0; }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width()) +
               static_cast<std::size_t>(x - x0);
    }
    const Pixel& at(int x, int y) const { return pixels[index(x, y)]; }
};

/// Renders a tile's pixels. Depths, normals, position, motion and id are those of the ray through
/// the pixel's centre when the shutter opens; colour, coverage and albedo are averages over the
/// pixel's samples, or the centre ray's where there is one sample. With a noise target noisy pixels
/// get more samples, see sample_adaptively().
/// @throws Stopped once `stop` is set
TileImage render_tile(const FrameScene& scene, const Tile& tile, const std::atomic<bool>& stop);

}  // namespace tesserae::render
