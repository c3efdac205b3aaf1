// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

#include "render/file/stamp.hpp"

namespace tesserae::scenes {

/// How much of each pixel of a small picture is covered, row by row.
struct Coverage {
    int width = 0, height = 0;
    std::vector<std::uint8_t> parts;  ///< of 255

    Coverage() = default;
    Coverage(int w, int h)
        : width(w), height(h), parts(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
    std::uint8_t& at(int x, int y) {
        return parts[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(x)];
    }
    std::uint8_t at(int x, int y) const {
        const bool inside = 0 <= x && x < width && 0 <= y && y < height;
        return inside ? const_cast<Coverage*>(this)->at(x, y) : 0;
    }
};

/// A stamp of one colour where it is covered, with a soft dark rim, so that it can be read over
/// light and dark. It is `rim` pixels larger on each side.
/// @param color   sRGB
render::Stamp with_rim(const Coverage& coverage, const std::array<std::uint8_t, 3>& color, int rim);

/// A font from a file, by FreeType.
class Font {
  public:
    /// @throws InputError   it cannot be read, or is no font
    explicit Font(const std::filesystem::path& file);
    ~Font();

    /// A line of text.
    /// @param utf8     what the font lacks is shown as the font's own sign for that
    /// @param pixels   the height of the font's em, 1 to 1000
    /// @param most     no wider than this [pixels]: smaller where it would be
    Coverage line(std::string_view utf8, int pixels, int most) const;

  private:
    struct Library;

    Coverage line_of(std::string_view utf8, int pixels) const;
    int width_of(std::string_view utf8, int pixels) const;

    std::filesystem::path file_;
    std::unique_ptr<Library> library_;
};

}  // namespace tesserae::scenes
