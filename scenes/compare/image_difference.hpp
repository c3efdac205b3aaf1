// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/file/image_pixels.hpp"

// Where two images differ, and by how much. Values are compared bit by bit.
namespace tesserae::scenes {

/// A pixel, counted from the data window's coordinates: x to the right, y down.
struct PixelDifference {
    int x = 0, y = 0;
    std::string channel;
    std::string a, b;       ///< shortest decimals that read back as the same values
    double difference = 0;  ///< |a - b|; no number where a value is none
};

/// A channel of both images, over the pixels that both hold.
struct ChannelDifference {
    std::string name;
    std::uint64_t pixels = 0;      ///< that differ in any bit
    std::uint64_t not_finite = 0;  ///< of those, the ones with an infinity or no number: they count
                                   ///< in nothing below
    double largest = 0;            ///< |a - b|
    int x = 0, y = 0;              ///< of the first such pixel, in raster order
    double rms = 0;                ///< root mean square of a - b over all pixels that both hold
};

struct ImageDifference {
    render::Crop window_a, window_b;
    std::vector<std::string> only_a, only_b;  ///< channels
    std::vector<std::string> other_type;      ///< "R: half in A, float in B"; not compared further
    std::optional<PixelDifference> first;     ///< in raster order, then by the channel's name
    std::vector<ChannelDifference> channels;  ///< of the same name and type, those that differ
};

/// Reads both in blocks of lines. @throws InputError   one cannot be read
ImageDifference compare_images(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace tesserae::scenes
