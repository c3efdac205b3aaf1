// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "render/file/stamp.hpp"
#include "render/tile/tile_image.hpp"

namespace tesserae::render {

/// [pixels]
struct PreviewSize {
    int width = 0, height = 0;
};

/// The size of a window's preview: settings.preview_size wide, or as the window where that is
/// narrower. One that is as wide as the window has its height; else the height is the even number
/// next to what the window's ratio gives, at least 2, as films want it.
PreviewSize preview_size_of(const Settings& settings, const Crop& window);

/// A row or column of the picture's pixels over one of the preview's. Lengths are counted in a unit
/// of which both kinds of pixel have a whole number: overlaps are exact.
class PreviewAxis {
  public:
    /// @param picture, preview   pixels along the axis
    PreviewAxis(int picture, int preview);

    /// Calls use(pixel of the preview, length of the overlap) for those that a pixel of the picture
    /// overlaps, ascending.
    template <class Use>
    void for_each_overlap(int pixel, const Use& use) const {
        const std::uint64_t begin = static_cast<std::uint64_t>(pixel) * of_picture_;
        const std::uint64_t end = begin + of_picture_;
        for (std::uint64_t i = begin / of_preview_; i * of_preview_ < end; ++i)
            use(i, std::min(end, (i + 1) * of_preview_) - std::max(begin, i * of_preview_));
    }
    /// Length of a preview's pixel, at most 65536.
    std::uint64_t length() const { return of_preview_; }

  private:
    std::uint64_t of_picture_, of_preview_;  ///< lengths of pixels
};

/// What a preview shows of a pixel, as the image file holds it: red, green, blue and coverage.
struct PreviewPixel {
    std::array<float, 4> color = {};
    std::array<float, 4> ghost = {};  ///< counts where ghosts lie over the preview
};

/// A small sRGB picture of a frame's window, gathered tile by tile: every preview pixel is the mean
/// of the picture's pixels over its area, each by the area that it has in it. Values are clamped to
/// [0, 1] after exposure and summed as integers, so that neither the order nor the size of the
/// tiles shows in the bytes. Where the sky is transparent the picture has the bodies' coverage as
/// its alpha, and their own colour, not premultiplied; the disc of a lamp, which has no coverage,
/// is as opaque as it is bright. Ghosts lie over what they are before with colours of their own,
/// which exposure does not change.
class Preview {
  public:
    /// @param settings   preview_size, exposure, sky and ghosts of them
    /// @param overlay    lies over all
    Preview(const Crop& window, const Settings& settings, std::span<const Stamp> overlay = {});

    void add(const TileImage& tile);
    /// Adds one pixel of the window.
    void add(int x, int y, const PreviewPixel& pixel);
    /// @throws RunError   the file cannot be written
    void write(const std::filesystem::path& path) const;

    /// Red, green, blue and coverage of a preview pixel, before they are divided; coverage is
    /// summed only where the sky is transparent.
    using Sum = std::array<std::uint64_t, 4>;
    /// By rows.
    std::span<const Sum> sums() const { return {sums_.get(), count()}; }
    const std::vector<Stamp>& overlay() const { return overlay_; }
    void set_overlay(std::vector<Stamp> stamps) { overlay_ = std::move(stamps); }
    /// Adds what another preview of the same window has gathered, from pixel `first` on.
    /// @return false if it reaches beyond the last
    bool add_sums(std::uint64_t first, std::span<const Sum> sums);

  private:
    struct Free {
        void operator()(Sum* sums) const { std::free(sums); }
    };
    std::size_t count() const {
        return static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(size_.height);
    }
    int channels() const { return sky_ == Sky::kTransparent ? 4 : 3; }
    std::vector<std::uint8_t> codes() const;  ///< sRGB, row by row

    Crop window_;
    double gain_;
    Sky sky_;
    GhostsIn ghosts_;
    std::vector<Stamp> overlay_;
    PreviewSize size_;
    PreviewAxis columns_, rows_;
    /// Zeros that take memory once they are written: a part of a frame has few of the pixels.
    std::unique_ptr<Sum[], Free> sums_;
};

}  // namespace tesserae::render
