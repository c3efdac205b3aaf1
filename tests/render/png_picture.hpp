// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace tesserae::render {

/// A PNG picture, row by row.
struct Png {
    std::uint32_t width = 0, height = 0;
    std::size_t channels = 0;  ///< 3, or 4 with alpha
    std::vector<std::uint8_t> codes;

    explicit Png(const std::filesystem::path& file) {
        png_image png = {};
        png.version = PNG_IMAGE_VERSION;
        EXPECT_TRUE(png_image_begin_read_from_file(&png, file.c_str()));
        channels = png.format & PNG_FORMAT_FLAG_ALPHA ? 4 : 3;
        png.format = channels == 4 ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
        width = png.width, height = png.height;
        codes.resize(PNG_IMAGE_SIZE(png));
        EXPECT_TRUE(png_image_finish_read(&png, nullptr, codes.data(), 0, nullptr));
    }

    /// The channels of a pixel.
    const std::uint8_t* at(int x, int y) const {
        return &codes[channels *
                      (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x))];
    }
};

/// sRGB code of a linear value in [0, 1], not rounded (IEC 61966-2-1).
inline double srgb_code(double v) {
    return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

}  // namespace tesserae::render
