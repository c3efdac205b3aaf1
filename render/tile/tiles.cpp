// SPDX-License-Identifier: Apache-2.0
#include "render/tile/tiles.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace tesserae::render {

TileSource::TileSource(std::span<const SliceBounds> slice, const Crop& window, int tile)
    : slice_(slice),
      window_(window),
      tile_(tile),
      columns_((window.x1 - window.x0 + tile - 1) / tile),
      rows_((window.y1 - window.y0 + tile - 1) / tile) {
    const unsigned side = std::bit_ceil(static_cast<unsigned>(std::max(columns_, rows_)));
    listed_.resize(static_cast<std::size_t>(std::bit_width(side)) + 1);
    // The first list stands above the root: every body, nearest first.
    listed_[0].resize(slice.size());
    std::iota(listed_[0].begin(), listed_[0].end(), 0u);
    std::stable_sort(listed_[0].begin(), listed_[0].end(), [&](std::uint32_t a, std::uint32_t b) {
        return slice[a].nearest < slice[b].nearest;
    });
    const int s = static_cast<int>(side);
    pending_.push_back({0, 0, s, 0, 0, s, 0});
}

std::optional<Tile> TileSource::next() {
    while (!pending_.empty()) {
        const Quad quad = pending_.back();
        pending_.pop_back();
        const Rect rect = rect_of(quad);
        if (rect.x0 >= columns_ || rect.y0 >= rows_) continue;

        // Bodies whose film rectangle meets the quad's pixels.
        const Crop p = pixels_of(rect);
        const auto& parent = listed_[quad.level];
        auto& list = listed_[quad.level + 1];
        list.clear();
        for (std::uint32_t i : parent) {
            const SliceBounds& s = slice_[i];
            if (s.x0 <= p.x1 && s.x1 >= p.x0 && s.y0 <= p.y1 && s.y1 >= p.y0) list.push_back(i);
        }
        if (rect.x1 - rect.x0 == 1) return Tile{rect.x0, rect.y0, p.x0, p.y0, p.x1, p.y1, list};
        divide(quad);
    }
    return std::nullopt;
}

/// The four quarters in the order of the curve: the first is turned over one diagonal, the last
/// over the other.
void TileSource::divide(const Quad& q) {
    const int ax = q.ax / 2, ay = q.ay / 2, bx = q.bx / 2, by = q.by / 2;
    const std::size_t level = q.level + 1;
    pending_.push_back({q.x + ax + q.bx, q.y + ay + q.by, -bx, -by, -ax, -ay, level});
    pending_.push_back({q.x + ax + bx, q.y + ay + by, ax, ay, bx, by, level});
    pending_.push_back({q.x + ax, q.y + ay, ax, ay, bx, by, level});
    pending_.push_back({q.x, q.y, bx, by, ax, ay, level});
}

TileSource::Rect TileSource::rect_of(const Quad& q) {
    const int x = q.x + q.ax + q.bx, y = q.y + q.ay + q.by;
    return {std::min(q.x, x), std::min(q.y, y), std::max(q.x, x), std::max(q.y, y)};
}

Crop TileSource::pixels_of(const Rect& r) const {
    // The root square may reach past the window by a factor of two and more: count in tiles first.
    const int x1 = std::min(r.x1, columns_), y1 = std::min(r.y1, rows_);
    return {window_.x0 + r.x0 * tile_, window_.y0 + r.y0 * tile_,
            std::min(window_.x0 + x1 * tile_, window_.x1),
            std::min(window_.y0 + y1 * tile_, window_.y1)};
}

}  // namespace tesserae::render
