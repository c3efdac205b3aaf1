// SPDX-License-Identifier: Apache-2.0
#include "render/file/image_pixels.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfVersion.h>
#include <half.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>

#include "core/error.hpp"
#include "render/file/exr_header.hpp"

namespace tesserae::render {
namespace {

static_assert(std::endian::native == std::endian::little, "values are handed out as they are read");

constexpr int kMostSide = 65536;
constexpr std::size_t kMostChannels = 64;
/// Bytes of what OpenEXR decompresses at once, usual some MiB: larger is refused.
constexpr double kMostTogether = 1 << 30;
/// Bytes of a block of lines, usual 4 MiB.
constexpr std::size_t kBlockBytes = std::size_t{4} << 20;
/// Lines that the compression with the largest blocks (DWAB) takes together.
constexpr int kMostLinesTogether = 256;

void require(bool good, const char* what) {
    if (!good) throw std::runtime_error(what);
}

std::vector<ImageChannel> checked_channels(const Imf::ChannelList& list) {
    std::vector<ImageChannel> channels;
    for (auto c = list.begin(); c != list.end(); ++c) {
        const Imf::Channel& channel = c.channel();
        require(channel.xSampling == 1 && channel.ySampling == 1, "holds a subsampled channel");
        require(channel.type >= 0 && channel.type < Imf::NUM_PIXELTYPES,
                "holds a channel of an unknown type");
        const PixelType type = channel.type == Imf::HALF    ? PixelType::kHalf
                               : channel.type == Imf::FLOAT ? PixelType::kFloat
                                                            : PixelType::kUint;
        channels.push_back({c.name(), type});
        require(channels.size() <= kMostChannels, "holds more than 64 channels");
    }
    require(!channels.empty(), "holds no channel");
    std::sort(channels.begin(), channels.end(),
              [](const ImageChannel& a, const ImageChannel& b) { return a.name < b.name; });
    return channels;
}

/// The data window, half open.
Crop checked_window(const Imf::Header& header) {
    const Imath::Box2i& data = header.dataWindow();
    const std::int64_t width = std::int64_t{data.max.x} - data.min.x + 1;
    const std::int64_t height = std::int64_t{data.max.y} - data.min.y + 1;
    require(width >= 1 && width <= kMostSide && height >= 1 && height <= kMostSide,
            "its data window has a side of more than 65536 pixels or none");
    require(
        std::max(std::abs(std::int64_t{data.min.x}), std::abs(std::int64_t{data.min.y})) < 1 << 30,
        "its data window is too far from the origin");
    return {data.min.x, data.min.y, data.max.x + 1, data.max.y + 1};
}

/// What OpenEXR would take memory for before it reads the first pixel.
void require_bounded(const Imf::Header& header, bool tiled, const Crop& window,
                     std::size_t pixel_bytes, std::uintmax_t file_bytes) {
    const double line =
        static_cast<double>(window.x1 - window.x0) * static_cast<double>(pixel_bytes);
    const int height = window.y1 - window.y0;
    double together = line * std::min(height, kMostLinesTogether);
    if (tiled) {
        require(header.hasTileDescription(), "does not say how large its tiles are");
        const Imf::TileDescription& tiles = header.tileDescription();
        require(tiles.mode == Imf::ONE_LEVEL,
                "holds levels of several sizes, which is not compared");
        require(tiles.xSize >= 1 && tiles.ySize >= 1 && tiles.xSize <= kMostSide &&
                    tiles.ySize <= kMostSide,
                "its tiles have a side of more than 65536 pixels or none");
        // A tile that reaches over the window's edge is still one whole tile of memory.
        together =
            std::max(line, static_cast<double>(tiles.xSize) * static_cast<double>(pixel_bytes)) *
            static_cast<double>(tiles.ySize);
        const auto side = [](int pixels, unsigned tile) { return 1.0 + (pixels - 1) / tile; };
        const double count = side(window.x1 - window.x0, tiles.xSize) * side(height, tiles.ySize);
        require(8 * count <= static_cast<double>(file_bytes), "has more tiles than bytes");
    }
    require(together <= kMostTogether, "needs more than 1 GiB for a row of tiles or lines");
}

}  // namespace

const char* name_of(PixelType type) {
    constexpr const char* kNames[] = {"half", "float", "uint"};
    return kNames[static_cast<std::size_t>(type)];
}

std::size_t bytes_of(PixelType type) { return type == PixelType::kHalf ? 2 : 4; }

double value_of(PixelType type, const unsigned char* bytes) {
    if (type == PixelType::kHalf) {
        std::uint16_t bits;
        std::memcpy(&bits, bytes, sizeof bits);
        half value;
        value.setBits(bits);
        return static_cast<double>(static_cast<float>(value));
    }
    std::uint32_t bits;
    std::memcpy(&bits, bytes, sizeof bits);
    return type == PixelType::kUint ? static_cast<double>(bits)
                                    : static_cast<double>(std::bit_cast<float>(bits));
}

struct ImagePixels::File {
    std::filesystem::path path;
    std::optional<Imf::InputFile> in;
    Crop window;
    std::vector<ImageChannel> channels;
    std::size_t line_bytes = 0;

    void open();

    template <class Work>
    void reading(Work&& work) {
        try {
            work();
        } catch (const std::exception& error) {
            throw InputError(
                fmt::format("{}: not a readable OpenEXR image: {}", path.string(), error.what()));
        }
    }
};

void ImagePixels::File::open() {
    const int version = checked_exr_header(path).version;
    require(!Imf::isMultiPart(version), "holds several parts, which is not compared");
    require(!Imf::isNonImage(version), "holds deep pixels, which is not compared");

    // Opening the image takes memory by what its header says.
    const Imf::Header header = read_exr_header(path);
    window = checked_window(header);
    channels = checked_channels(header.channels());
    std::size_t pixel_bytes = 0;
    for (const ImageChannel& channel : channels) pixel_bytes += bytes_of(channel.type);
    line_bytes = pixel_bytes * static_cast<std::size_t>(window.x1 - window.x0);
    require_bounded(header, Imf::isTiled(version), window, pixel_bytes,
                    std::filesystem::file_size(path));
    in.emplace(path.c_str(), 0);
}

ImagePixels::ImagePixels(const std::filesystem::path& file) : file_(std::make_unique<File>()) {
    file_->path = file;
    file_->reading([&] { file_->open(); });
}

ImagePixels::~ImagePixels() = default;

const Crop& ImagePixels::window() const { return file_->window; }
const std::vector<ImageChannel>& ImagePixels::channels() const { return file_->channels; }

void ImagePixels::read(int y0, int y1, PixelPlanes& planes) const {
    const Crop& window = file_->window;
    TSR_ASSERT(window.y0 <= y0 && y0 < y1 && y1 <= window.y1);
    const int width = window.x1 - window.x0;
    constexpr Imf::PixelType kTypes[] = {Imf::HALF, Imf::FLOAT, Imf::UINT};
    Imf::FrameBuffer buffer;
    planes.resize(channels().size());
    for (std::size_t c = 0; c < planes.size(); ++c) {
        const ImageChannel& channel = channels()[c];
        planes[c].resize(bytes_of(channel.type) * static_cast<std::size_t>(width) *
                         static_cast<std::size_t>(y1 - y0));
        buffer.insert(channel.name, Imf::Slice::Make(kTypes[static_cast<std::size_t>(channel.type)],
                                                     planes[c].data(), Imath::V2i(window.x0, y0),
                                                     width, y1 - y0));
    }
    file_->reading([&] {
        file_->in->setFrameBuffer(buffer);
        file_->in->readPixels(y0, y1 - 1);
    });
}

int ImagePixels::block_lines() const {
    return static_cast<int>(std::max<std::size_t>(1, kBlockBytes / file_->line_bytes));
}

void ImagePixels::for_each_block(
    const std::function<void(int, int, const PixelPlanes&)>& work) const {
    PixelPlanes planes;
    const Crop& window = file_->window;
    for (int y = window.y0; y < window.y1;) {
        const int end = std::min(window.y1, y + block_lines());
        read(y, end, planes);
        work(y, end, planes);
        y = end;
    }
}

}  // namespace tesserae::render
