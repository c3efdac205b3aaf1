// SPDX-License-Identifier: Apache-2.0
#include "render/file/channel_places.hpp"

#include <fmt/format.h>

#include <initializer_list>

namespace tesserae::render {
namespace {

constexpr PixelType kHalf = PixelType::kHalf, kFloat = PixelType::kFloat, kUint = PixelType::kUint;

/// Collects the channels of layers.
class Places {
  public:
    /// Adds channels that lie in a record one after the other.
    void add(const char* layer, Record record, PixelType type, std::size_t first,
             std::initializer_list<const char*> names) {
        for (const char* name : names) {
            list.push_back({name, type, first, record, layer});
            first += bytes_of(type);
        }
    }

    /// Adds two ranks to a layer of the file: CryptoObject00.R to .A, CryptoObject01.R...
    void add_mattes(const char* name, std::size_t offset) {
        for (std::size_t i = 0; i < 2 * MattePixel::kRanks; ++i)
            list.push_back({fmt::format("{}{:02}.{}", name, i / 4, "RGBA"[i % 4]), kFloat,
                            offset + i * sizeof(float), Record::kMattes, "cryptomatte"});
    }

    std::vector<ChannelPlace> list;
};

/// Of the record of every pixel.
void add_pixels(const Channels& wanted, Places& places) {
    const auto add = [&](bool want, const char* layer, PixelType type, std::size_t first,
                         std::initializer_list<const char*> names) {
        if (want) places.add(layer, Record::kPixel, type, first, names);
    };
    add(wanted.color, "color", kHalf, offsetof(Pixel, color), {"R", "G", "B"});
    add(wanted.color, "color", kHalf, offsetof(Pixel, alpha), {"A"});
    add(wanted.depth, "depth", kFloat, offsetof(Pixel, depth), {"Z"});
    add(wanted.albedo, "albedo", kHalf, offsetof(Pixel, albedo),
        {"albedo.R", "albedo.G", "albedo.B"});
    add(wanted.normal, "normal", kFloat, offsetof(Pixel, normal), {"N.X", "N.Y", "N.Z", "N.W"});
    add(wanted.position, "position", kFloat, offsetof(Pixel, position),
        {"P.X", "P.Y", "P.Z", "P.W"});
    add(wanted.variance, "variance", kFloat, offsetof(Pixel, variance),
        {"variance.R", "variance.G", "variance.B"});
    add(wanted.samples, "samples", kUint, offsetof(Pixel, samples), {"samples"});
    add(wanted.id, "id", kUint, offsetof(Pixel, id), {"objectid"});
}

/// Of the record that pixels have where one of these is asked for.
void add_layers(const Settings& settings, Places& places) {
    const auto add = [&](bool want, const char* layer, PixelType type, std::size_t first,
                         std::initializer_list<const char*> names) {
        if (want) places.add(layer, Record::kLayers, type, first, names);
    };
    const Channels& wanted = settings.channels;
    add(wanted.motion, "motion", kFloat, offsetof(LayerPixel, forward), {"forward.u", "forward.v"});
    add(wanted.motion, "motion", kFloat, offsetof(LayerPixel, backward),
        {"backward.u", "backward.v"});
    add(wanted.zplanar, "zplanar", kFloat, offsetof(LayerPixel, plane_depth), {"Zplanar"});
    add(wanted.normal3, "normal3", kFloat, offsetof(LayerPixel, slice_normal),
        {"Nslice.X", "Nslice.Y", "Nslice.Z"});
    add(wanted.light, "light", kHalf, offsetof(LayerPixel, direct),
        {"direct.R", "direct.G", "direct.B"});
    add(wanted.light, "light", kHalf, offsetof(LayerPixel, indirect),
        {"indirect.R", "indirect.G", "indirect.B"});
    add(settings.has_ghosts(), "ghost", kHalf, offsetof(LayerPixel, ghost),
        {"ghost.R", "ghost.G", "ghost.B", "ghost.A"});
}

}  // namespace

std::vector<ChannelPlace> channel_places(const Settings& settings) {
    Places places;
    add_pixels(settings.channels, places);
    add_layers(settings, places);
    if (settings.channels.cryptomatte) {
        places.add_mattes(kObjectMattes, offsetof(MattePixel, objects));
        places.add_mattes(kMaterialMattes, offsetof(MattePixel, materials));
    }
    return std::move(places.list);
}

std::vector<ChannelPlace> all_channel_places() {
    Settings all;
    all.channels = {true, true, true, true, true, true, true, true, true, true, true, true, true};
    all.ghost_depth = 1;
    return channel_places(all);
}

std::pair<const char*, std::size_t> records_of(const TileImage& tile, Record record) {
    const auto bytes = [](const auto& records) {
        return std::pair(reinterpret_cast<const char*>(records.data()), sizeof records[0]);
    };
    if (record == Record::kLayers) return bytes(tile.layers);
    if (record == Record::kMattes) return bytes(tile.mattes);
    return bytes(tile.pixels);
}

}  // namespace tesserae::render
