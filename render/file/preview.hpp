#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "render/file/stamp.hpp"
#include "render/tile/tile_image.hpp"

namespace tesserae::render {

struct PreviewSize {
    int width, height;  ///< [pixels]
};
PreviewSize preview_size(const Settings& settings);

/// What a preview shows of a pixel, as the image file holds it: red, green, blue and coverage.
struct PreviewPixel {
    std::array<float, 4> color = {};
    std::array<float, 4> ghost = {};  ///< counts where ghosts lie over the preview
};

/// A small sRGB picture of a frame's window, gathered tile by tile: every preview pixel is the mean
/// of a square of k x k film pixels (fewer at the right and bottom border), k the least that makes
/// it at most 1920 wide and 4096 high. Values are clamped to [0, 1] after exposure and summed as
/// integers, so that neither the order nor the size of the tiles shows in the bytes. Where the sky
/// is transparent the picture has the bodies' coverage as its alpha, and their own colour, not
/// premultiplied; the disc of a lamp, which has no coverage, is as opaque as it is bright.
/// Ghosts lie over what they are before with colours of their own, which exposure does not change.
class Preview {
  public:
    /// @param settings   exposure, sky and ghosts count
    /// @param overlay    lies over all
    Preview(const Crop& window, const Settings& settings, std::span<const Stamp> overlay = {});

    void add(const TileImage& tile);
    /// Adds one pixel of the window.
    void add(int x, int y, const PreviewPixel& pixel);
    /// @throws RunError   the file cannot be written
    void write(const std::filesystem::path& path) const;

    /// Red, green, blue and coverage of a preview pixel, before they are divided; coverage is
    /// summed only where the sky is transparent.
    using Sum = std::array<std::uint32_t, 4>;
    /// By rows.
    std::span<const Sum> sums() const { return sums_; }
    const std::vector<Stamp>& overlay() const { return overlay_; }
    void set_overlay(std::vector<Stamp> stamps) { overlay_ = std::move(stamps); }
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
    GhostsIn ghosts_;
    std::vector<Stamp> overlay_;
    int factor_, width_, height_;
    std::vector<Sum> sums_;
};

}  // namespace tesserae::render
