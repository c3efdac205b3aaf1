#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "render/tile/tile_image.hpp"

namespace tesserae::render {

/// A small sRGB picture of a frame's window, gathered tile by tile: every preview pixel is the mean
/// of a square of k x k film pixels (fewer at the right and bottom border), k the least that makes
/// it at most 1920 wide and 4096 high. Values are clamped to [0, 1] after exposure and summed as
/// integers, so that neither the order nor the size of the tiles shows in the bytes. Where the sky
/// is transparent the picture has the bodies' coverage as its alpha, and their own colour, not
/// premultiplied; the disc of a lamp, which has no coverage, is as opaque as it is bright.
class Preview {
  public:
    /// @param exposure   [stops]
    Preview(const Crop& window, double exposure, Sky sky);

    void add(const TileImage& tile);
    /// Adds one pixel of the window, as the image file holds it.
    void add(int x, int y, float red, float green, float blue, float coverage);
    /// @throws RunError   the file cannot be written
    void write(const std::filesystem::path& path) const;

    /// Red, green, blue and coverage of a preview pixel, before they are divided; coverage is
    /// summed only where the sky is transparent.
    using Sum = std::array<std::uint32_t, 4>;
    /// By rows.
    std::span<const Sum> sums() const { return sums_; }
    /// Adds what another preview of the same window has gathered, from pixel `first` on.
    /// @return false if it reaches beyond the last
    bool add_sums(std::uint64_t first, std::span<const Sum> sums);

    int width() const { return width_; }
    int height() const { return height_; }

  private:
    Sum& sum_at(int x, int y);
    int channels() const { return sky_ == Sky::kTransparent ? 4 : 3; }
    std::vector<std::uint8_t> codes() const;  ///< sRGB, row by row

    Crop window_;
    double gain_;
    Sky sky_;
    int factor_, width_, height_;
    std::vector<Sum> sums_;
};

}  // namespace tesserae::render
