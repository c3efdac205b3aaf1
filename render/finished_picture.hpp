// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tesserae {

/// A rendered picture in memory. Copies share the pixels, which do not change.
///
/// Its layers have the names of the channels of scene files (`render.channels`):
///
///     color      4   R, G, B, A: linear Rec. 709; the alpha is the bodies' coverage
///     depth      1   distance along the view ray [m]; infinite where no body is
///     normal     4   x, y, z, w, world
///     albedo     3   R, G, B
///     id         1   number of the body + 1; 0: none
///     position   4   x, y, z, w, world [m]
///     variance   3   of the pixel's mean colour
///     samples    1   how many the pixel took
///     motion     4   to where the point is in the next frame, right and up, and was in the last
///     [pixels] zplanar    1   along the camera's forward axis [m] normal3    3   of the
///     cross-section, in the camera's right, up, forward light      6   direct, then indirect: R,
///     G, B each cryptomatte  24   six ranks of objects, then of materials: id and coverage each
///     ghost      4   bodies beside the slice: R, G, B, A
///
/// Values are those that the image file holds, as floats: colours were rounded to half precision.
class Picture {
  public:
    /// Reads an image that tesserae has written: a frame of a film, or what write_image() wrote. Of
    /// other images it takes the channels that have such names. Its preview is without exposure and
    /// overlay.
    /// @throws InputError   it cannot be read, is damaged, or is no OpenEXR image of one part with
    ///                      such channels
    static Picture read(const std::filesystem::path& exr);

    int width() const;   ///< [pixels]
    int height() const;  ///< [pixels]
    /// Returns where the upper left pixel is in the full frame: 0, 0 but for a crop [pixels].
    int left() const;
    int top() const;

    /// Returns the layers that the picture has.
    const std::vector<std::string>& layers() const;
    bool has(std::string_view layer) const;
    /// Returns the names of a layer's channels in OpenEXR files, as "albedo.R".
    /// @throws InputError   the picture has no such layer
    const std::vector<std::string>& channels(std::string_view layer) const;
    /// Returns a layer's values: rows from the top down, in each the pixels from left to right, of
    /// each the channels. The span is valid as long as a copy of the picture is.
    /// @throws InputError   the picture has no such layer
    std::span<const float> layer(std::string_view name) const;

    /// Returns a line for each thing that is wrong with the pixels: samples that were no number,
    /// colours beyond what a file holds, light paths that were cut off.
    const std::vector<std::string>& warnings() const;

    /// Writes an OpenEXR file, with the bytes that rendering into a file gives.
    /// @throws RunError     it cannot be written
    /// @throws InputError   the name does not end in .exr
    void write_image(const std::filesystem::path& exr) const;
    /// Writes an sRGB picture for the eye: the preview that rendering into a folder gives.
    /// @throws RunError     it cannot be written
    /// @throws InputError   the picture has no layer "color"; the name does not end in .png
    void write_preview(const std::filesystem::path& png) const;

    /// What is in it; only the renderer makes one.
    struct Inside;
    /// @param inside   not null
    explicit Picture(std::shared_ptr<const Inside> inside) : inside_(std::move(inside)) {}

  private:
    std::shared_ptr<const Inside> inside_;
};

}  // namespace tesserae
