// SPDX-License-Identifier: Apache-2.0
#include "render/file/exr_writer.hpp"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfFramesPerSecond.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "render/file/channel_places.hpp"
#include "render/file/image_info.hpp"

namespace tesserae::render {
namespace {

/// OpenEXR's stream over the project's writer, which remembers failures that OpenEXR swallows.
class Stream : public Imf::OStream {
  public:
    explicit Stream(const std::filesystem::path& path) : Imf::OStream(path.c_str()), writer(path) {}

    void write(const char bytes[], int count) override {
        writer.write(bytes, static_cast<std::size_t>(count));
    }
    std::uint64_t tellp() override { return writer.position(); }
    void seekp(std::uint64_t position) override { writer.seek(position); }

    FileWriter writer;
};

/// OpenEXR's stream into memory: it knows every position, and keeps what was written last.
class MemoryStream : public Imf::OStream {
  public:
    MemoryStream() : Imf::OStream("tile") {}

    void write(const char data[], int count) override {
        bytes.insert(bytes.end(), data, data + count);
        position_ += static_cast<std::uint64_t>(count);
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::vector<char> bytes;

  private:
    std::uint64_t position_ = 0;
};

Imf::PixelType imf_type(PixelType type) {
    constexpr Imf::PixelType kTypes[] = {Imf::HALF, Imf::FLOAT, Imf::UINT};
    return kTypes[static_cast<std::size_t>(type)];
}

Imf::Compression compression_of(Compression compression) {
    switch (compression) {
        case Compression::kNone:
            return Imf::NO_COMPRESSION;
        case Compression::kRle:
            return Imf::RLE_COMPRESSION;
        case Compression::kZips:
            return Imf::ZIPS_COMPRESSION;
        case Compression::kZip:
            return Imf::ZIP_COMPRESSION;
        case Compression::kPiz:
            return Imf::PIZ_COMPRESSION;
    }
    TSR_ASSERT(false);
    return Imf::ZIP_COMPRESSION;
}

std::string exact(const Vec4& v) {
    return fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", v[0], v[1], v[2], v[3]);
}

/// Says of a Cryptomatte layer how to read it (its specification 1.2.0, "Metadata").
void describe_mattes(const char* layer, const MatteNames& names, Imf::Header& header) {
    const std::string key =
        fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", murmur3(layer)));
    const auto text = [&](const char* name, const std::string& value) {
        header.insert(key + name, Imf::StringAttribute(value));
    };
    text("name", layer);
    text("hash", "MurmurHash3_32");
    text("conversion", "uint32_to_float32");
    text(names.is_file ? "manif_file" : "manifest", names.manifest);
}

Imf::Header header_of(const Settings& settings, const Crop& window, const FrameInfo& info,
                      const CameraDescription& description, const Camera& camera,
                      const Mattes* mattes) {
    const Imath::Box2i display({0, 0}, {settings.width - 1, settings.height - 1});
    const Imath::Box2i data({window.x0, window.y0}, {window.x1 - 1, window.y1 - 1});
    Imf::Header header(display, data);
    header.compression() = compression_of(settings.compression);
    header.lineOrder() = Imf::RANDOM_Y;
    const auto side = static_cast<unsigned>(settings.tile);
    header.setTileDescription(Imf::TileDescription(side, side, Imf::ONE_LEVEL));
    for (const ChannelPlace& place : channel_places(settings))
        header.channels().insert(place.name, Imf::Channel(imf_type(place.type)));
    Imf::addChromaticities(header, Imf::Chromaticities());
    Imf::addFramesPerSecond(header, Imf::guessExactFps(settings.frames_per_second));

    const auto text = [&](const char* name, const std::string& value) {
        header.insert(name, Imf::StringAttribute(value));
    };
    text("tesserae/scene", info.scene_name);
    text(kSceneHashAttribute, info.scene_hash);
    text("tesserae/version", info.program_version);
    text("tesserae/idNames", info.id_names);
    text("tesserae/cameraOrigin", exact(camera.origin()));
    text("tesserae/cameraRight", exact(camera.right()));
    text("tesserae/cameraUp", exact(camera.up()));
    text("tesserae/cameraForward", exact(camera.forward()));
    text("tesserae/cameraFourth", exact(camera.fourth()));
    header.insert("tesserae/fieldOfView", Imf::DoubleAttribute(description.field_of_view));
    header.insert("tesserae/time", Imf::DoubleAttribute(info.time));
    header.insert(kMotionVersionAttribute, Imf::IntAttribute(info.motion_version));
    header.insert(kPictureVersionAttribute, Imf::IntAttribute(info.picture_version));
    header.insert("tesserae/frame", Imf::IntAttribute(info.frame));
    header.insert("tesserae/samples", Imf::IntAttribute(settings.samples));
    if (settings.channels.cryptomatte) {
        TSR_ASSERT(mattes != nullptr);
        describe_mattes(kObjectMattes, mattes->object_names, header);
        describe_mattes(kMaterialMattes, mattes->material_names, header);
    }
    return header;
}

/// A file in memory with the same header: what OpenEXR writes there for a tile is what the real
/// file needs.
struct Packer {
    MemoryStream stream;
    Imf::TiledOutputFile tiles;

    explicit Packer(const Imf::Header& header) : tiles(stream, header, 0) {}
};

}  // namespace

/// OpenEXR can compress on threads of its own, but only tiles that make a rectangle, and not those
/// of a Hilbert curve as they come. So every thread compresses into a file of its own, and the
/// results are put in a row, with the table that says where they are.
struct TilePacker::Packers {
    Imf::Header header;
    std::vector<ChannelPlace> places;
    std::string file_header;
    std::uint64_t columns, tiles;
    tbb::enumerable_thread_specific<Packer> of_thread;

    Packers(const Imf::Header& head, std::vector<ChannelPlace> channels)
        : header(head), places(std::move(channels)), of_thread([this] { return Packer(header); }) {
        const Packer first(header);
        file_header.assign(first.stream.bytes.begin(), first.stream.bytes.end());
        columns = static_cast<std::uint64_t>(first.tiles.numXTiles());
        tiles = columns * static_cast<std::uint64_t>(first.tiles.numYTiles());
    }
};

TilePacker::TilePacker(const Settings& settings, const Crop& window, const FrameInfo& info,
                       const CameraDescription& description, const Camera& camera,
                       const Mattes* mattes) {
    if (channel_places(settings).empty())
        throw InputError("render.channels = []: an image needs at least one channel");
    packers_ = std::make_unique<Packers>(
        header_of(settings, window, info, description, camera, mattes), channel_places(settings));
}

TilePacker::~TilePacker() = default;

std::string TilePacker::file_header() const { return packers_->file_header; }

std::uint64_t TilePacker::tiles() const { return packers_->tiles; }

/// The file itself: tiles that were packed, and where they are.
struct ExrWriter::File {
    Stream stream;
    std::optional<Imf::TiledOutputFile> tiles;
    std::uint64_t table;                 ///< where the file holds the tiles' positions
    std::vector<std::uint64_t> offsets;  ///< of the tiles, by rows; 0 where none is written

    File(const std::filesystem::path& path, const Imf::Header& header, std::uint64_t count)
        : stream(path), offsets(count) {
        // No threads of OpenEXR's own: tiles come from threads enough.
        tiles.emplace(stream, header, 0);
        table = stream.tellp() - sizeof(std::uint64_t) * offsets.size();
    }

    bool has_tiles() const {
        return std::any_of(offsets.begin(), offsets.end(), [](auto o) { return o != 0; });
    }
};

ExrWriter::ExrWriter(const std::filesystem::path& path, const Settings& settings,
                     const Crop& window, const FrameInfo& info,
                     const CameraDescription& description, const Camera& camera,
                     const Mattes* mattes)
    : packer_(settings, window, info, description, camera, mattes),
      file_(std::make_unique<File>(path, packer_.packers_->header, packer_.tiles())) {}

ExrWriter::~ExrWriter() = default;

PackedTile TilePacker::pack(const TileImage& tile) {
    // Channels lie interleaved in the tile's records.
    const Imath::V2i corner(tile.x0, tile.y0);
    Imf::FrameBuffer buffer;
    for (const ChannelPlace& place : packers_->places) {
        const auto [records, stride] = records_of(tile, place.record);
        buffer.insert(place.name,
                      Imf::Slice::Make(imf_type(place.type), records + place.offset, corner,
                                       tile.width(), tile.y1 - tile.y0, stride,
                                       stride * static_cast<std::size_t>(tile.width())));
    }
    Packer& packer = packers_->of_thread.local();
    packer.stream.bytes.clear();
    packer.tiles.setFrameBuffer(buffer);
    packer.tiles.writeTile(tile.column, tile.row);
    const auto row = static_cast<std::uint64_t>(tile.row);
    return {row * packers_->columns + static_cast<std::uint64_t>(tile.column), packer.stream.bytes};
}

void ExrWriter::write(const PackedTile& tile) {
    file_->offsets[tile.index] = file_->stream.tellp();
    file_->stream.write(tile.bytes.data(), static_cast<int>(tile.bytes.size()));
}

void ExrWriter::copy_tiles(const std::filesystem::path& other) {
    try {
        Imf::TiledInputFile in(other.c_str(), 0);
        file_->tiles->copyPixels(in);
    } catch (const Iex::BaseExc& error) {
        throw RunError(fmt::format("{}: cannot be copied: {}", other.string(), error.what()));
    }
}

void ExrWriter::finish() {
    // Its destructor writes the table of the tiles that were copied.
    file_->tiles.reset();
    if (file_->has_tiles()) {
        // EXR files are little-endian everywhere.
        static_assert(std::endian::native == std::endian::little);
        const std::uint64_t end = file_->stream.tellp();
        file_->stream.seekp(file_->table);
        file_->stream.write(reinterpret_cast<const char*>(file_->offsets.data()),
                            static_cast<int>(sizeof(std::uint64_t) * file_->offsets.size()));
        file_->stream.seekp(end);
    }
    file_->stream.writer.finish();
}

}  // namespace tesserae::render
