// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "render/scene/slice.hpp"

namespace tesserae::render {

/// A rectangle of pixels, half open, and the bodies that its view rays can meet.
struct Tile {
    int column = 0, row = 0;  ///< in the grid of tiles
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    std::vector<std::uint32_t> candidates;  ///< indices into the slice bounds, nearest first
};

/// Hands out the tiles of a window of the film one by one along a Hilbert curve, each with its list
/// of candidates. The curve is walked as the quadtree that it is: a quad's list is made from its
/// parent's, so that memory is a few lists whatever the film's size, and a tile's list costs about
/// as much as the list is long.
class TileSource {
  public:
    /// @param slice    must outlive the source
    /// @param window   pixels, half open; the grid of tiles starts at its top left corner
    /// @param tile     side of a tile [pixels]
    TileSource(std::span<const SliceBounds> slice, const Crop& window, int tile);

    /// The next tile, or nothing after the last.
    std::optional<Tile> next();

  private:
    /// A square of the curve: the corner where the curve enters, in tiles, and its two sides, which
    /// point along or against the axes.
    struct Quad {
        int x, y;
        int ax, ay, bx, by;
        std::size_t level;  ///< depth in the quadtree, the whole film's square being 0
    };
    struct Rect {
        int x0, y0, x1, y1;  ///< half open, in tiles
    };
    static Rect rect_of(const Quad& quad);
    Crop pixels_of(const Rect& tiles) const;
    void divide(const Quad& quad);

    std::span<const SliceBounds> slice_;
    Crop window_;
    int tile_;
    int columns_, rows_;
    std::vector<Quad> pending_;                       ///< a stack
    std::vector<std::vector<std::uint32_t>> listed_;  ///< by level, of the quad last met there
};

}  // namespace tesserae::render
