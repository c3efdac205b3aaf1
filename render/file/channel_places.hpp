// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "render/description.hpp"
#include "render/file/image_pixels.hpp"
#include "render/tile/tile_image.hpp"

namespace tesserae::render {

/// What a tile holds of a pixel.
enum class Record { kPixel, kLayers, kMattes };

/// A channel of an image file and where it lies in a pixel's record.
struct ChannelPlace {
    std::string name;
    PixelType type;
    std::size_t offset;
    Record record = Record::kPixel;
    const char* layer = "";  ///< what scene files call it and the channels beside it
};

/// Names of the two Cryptomatte layers.
inline constexpr const char* kObjectMattes = "CryptoObject";
inline constexpr const char* kMaterialMattes = "CryptoMaterial";

/// The channels that a picture's file has. Those of a layer follow each other.
std::vector<ChannelPlace> channel_places(const Settings& settings);
/// The channels that files can have.
std::vector<ChannelPlace> all_channel_places();

/// The first pixel's record of a tile, and how far it is to the next one's.
std::pair<const char*, std::size_t> records_of(const TileImage& tile, Record record);

}  // namespace tesserae::render
