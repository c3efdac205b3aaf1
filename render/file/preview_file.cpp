// SPDX-License-Identifier: Apache-2.0
#include "render/file/preview_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "render/file/image_pixels.hpp"

namespace tesserae::render {
namespace {

/// A chunk of a PNG file is four bytes of length, four of type, the content, four of checksum; the
/// checksum is that of type and content (PNG specification, 5.3).
constexpr std::size_t kNumber = 4, kType = 4;
/// Bytes of a preview's chunk, usual 8 KiB: more is no preview.
constexpr std::uint32_t kMostContent = 1u << 28;

std::uint32_t number_at(const unsigned char* bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < kNumber; ++i) value = value << 8 | bytes[i];
    return value;
}

/// @return what is wrong, or an empty text
std::string damage_in(std::istream& in, std::uint64_t left, const PreviewSize& size) {
    constexpr const char *kCut = "is cut off", *kOther = "is no PNG picture";
    std::array<unsigned char, 8> head;
    const auto read = [&](void* to, std::size_t count) {
        if (count > left) return false;
        left -= count;
        return bool(in.read(static_cast<char*>(to), static_cast<std::streamsize>(count)));
    };
    if (!read(head.data(), head.size())) return kCut;
    if (std::memcmp(head.data(), "\x89PNG\r\n\x1a\n", head.size()) != 0) return kOther;
    std::vector<unsigned char> chunk;
    for (bool is_first = true;; is_first = false) {
        if (!read(head.data(), kNumber)) return kCut;
        const std::uint32_t length = number_at(head.data());
        if (length > kMostContent) return kOther;
        if (length > left) return kCut;
        chunk.resize(kType + length + kNumber);
        if (!read(chunk.data(), chunk.size())) return kCut;
        const auto found = crc32(0, chunk.data(), static_cast<uInt>(kType + length));
        if (found != number_at(chunk.data() + kType + length)) return "has a damaged chunk";
        const std::string_view type(reinterpret_cast<const char*>(chunk.data()), kType);
        if (is_first) {
            if (type != "IHDR" || length < 2 * kNumber) return kOther;
            const std::uint32_t width = number_at(&chunk[kType]),
                                height = number_at(&chunk[kType + kNumber]);
            if (std::cmp_not_equal(width, size.width) || std::cmp_not_equal(height, size.height))
                return fmt::format("has {}x{} pixels, not {}x{}", width, height, size.width,
                                   size.height);
        }
        if (type == "IEND") return left == 0 ? "" : "goes on after its end";
    }
}

/// One value of a plane of pixels.
float value_at(const PixelPlanes& planes, const std::vector<ImageChannel>& channels,
               std::size_t channel, std::size_t pixel) {
    const PixelType type = channels[channel].type;
    return static_cast<float>(value_of(type, &planes[channel][bytes_of(type) * pixel]));
}

/// Of red, green, blue and alpha among an image's channels.
using ColorPlaces = std::array<std::size_t, 4>;

/// @param layer   before the channels' names
/// @return nothing where one is missing
std::optional<ColorPlaces> places_of(const std::vector<ImageChannel>& channels,
                                     std::string_view layer) {
    ColorPlaces places;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const std::string name = fmt::format("{}{}", layer, "RGBA"[i]);
        const auto found = std::find_if(channels.begin(), channels.end(),
                                        [&](const ImageChannel& c) { return c.name == name; });
        if (found == channels.end()) return std::nullopt;
        places[i] = static_cast<std::size_t>(found - channels.begin());
    }
    return places;
}

}  // namespace

std::string damage_of_preview(const std::filesystem::path& file, const PreviewSize& size) {
    std::error_code error;
    const std::uint64_t bytes = std::filesystem::file_size(file, error);
    std::ifstream in(file, std::ios::binary);
    if (error || !in) return fmt::format("{}: cannot be read", file.string());
    const std::string damage = damage_in(in, bytes, size);
    return damage.empty() ? "" : fmt::format("{}: {}", file.string(), damage);
}

bool remake_preview(const std::filesystem::path& exr, const Settings& settings,
                    std::span<const Stamp> overlay, const std::filesystem::path& preview) {
    const ImagePixels image(exr);
    const std::vector<ImageChannel>& channels = image.channels();
    const auto color = places_of(channels, ""), ghost = places_of(channels, "ghost.");
    if (!color) return false;
    const Crop& window = image.window();
    Preview small(window, settings, overlay);
    image.for_each_block([&](int y0, int y1, const PixelPlanes& planes) {
        std::size_t pixel = 0;
        const auto values = [&](const ColorPlaces& places) {
            std::array<float, 4> rgba;
            for (std::size_t i = 0; i < 4; ++i)
                rgba[i] = value_at(planes, channels, places[i], pixel);
            return rgba;
        };
        for (int y = y0; y < y1; ++y)
            for (int x = window.x0; x < window.x1; ++x, ++pixel)
                small.add(x, y, {values(*color), ghost ? values(*ghost) : std::array<float, 4>{}});
    });
    small.write(preview);
    return true;
}

}  // namespace tesserae::render
