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

/// What a tile holds of a pixel.
enum class Record { kPixel, kLayers, kMattes };

/// A channel of the file and where it lies in a pixel's record.
struct ChannelPlace {
    std::string name;
    Imf::PixelType type;
    std::size_t offset;
    Record record = Record::kPixel;
};

/// The first pixel's record of a tile, and how far it is to the next one's.
std::pair<const char*, std::size_t> records_of(const TileImage& tile, Record record) {
    const auto bytes = [](const auto& records) {
        return std::pair(reinterpret_cast<const char*>(records.data()), sizeof records[0]);
    };
    if (record == Record::kLayers) return bytes(tile.layers);
    if (record == Record::kMattes) return bytes(tile.mattes);
    return bytes(tile.pixels);
}

constexpr const char* kObjectMattes = "CryptoObject";
constexpr const char* kMaterialMattes = "CryptoMaterial";

/// Two ranks to a layer: CryptoObject00.R to .A, CryptoObject01.R...
void add_mattes(const char* layer, std::size_t offset, std::vector<ChannelPlace>& places) {
    for (std::size_t i = 0; i < 2 * MattePixel::kRanks; ++i)
        places.push_back({fmt::format("{}{:02}.{}", layer, i / 4, "RGBA"[i % 4]), Imf::FLOAT,
                          offset + i * sizeof(float), Record::kMattes});
}

void add_layers(const Settings& settings, std::vector<ChannelPlace>& places) {
    const Channels& wanted = settings.channels;
    const auto add = [&](bool want, Imf::PixelType type, std::size_t first,
                         std::initializer_list<const char*> names) {
        if (!want) return;
        const std::size_t size = type == Imf::HALF ? sizeof(Imath::half) : sizeof(float);
        for (const char* name : names) {
            places.push_back({name, type, first, Record::kLayers});
            first += size;
        }
    };
    add(wanted.motion, Imf::FLOAT, offsetof(LayerPixel, forward), {"forward.u", "forward.v"});
    add(wanted.motion, Imf::FLOAT, offsetof(LayerPixel, backward), {"backward.u", "backward.v"});
    add(wanted.zplanar, Imf::FLOAT, offsetof(LayerPixel, plane_depth), {"Zplanar"});
    add(wanted.normal3, Imf::FLOAT, offsetof(LayerPixel, slice_normal),
        {"Nslice.X", "Nslice.Y", "Nslice.Z"});
    add(wanted.light, Imf::HALF, offsetof(LayerPixel, direct),
        {"direct.R", "direct.G", "direct.B"});
    add(wanted.light, Imf::HALF, offsetof(LayerPixel, indirect),
        {"indirect.R", "indirect.G", "indirect.B"});
    add(settings.has_ghosts(), Imf::HALF, offsetof(LayerPixel, ghost),
        {"ghost.R", "ghost.G", "ghost.B", "ghost.A"});
}

std::vector<ChannelPlace> places_of(const Settings& settings) {
    const Channels& wanted = settings.channels;
    constexpr std::size_t kColor = offsetof(Pixel, color), kAlbedo = offsetof(Pixel, albedo);
    constexpr std::size_t kNormal = offsetof(Pixel, normal), kPosition = offsetof(Pixel, position);
    std::vector<ChannelPlace> places;
    const auto add = [&](bool want, std::initializer_list<ChannelPlace> list) {
        if (!want) return;
        for (const ChannelPlace& place : list) places.push_back(place);
    };
    add(wanted.color, {{"R", Imf::HALF, kColor},
                       {"G", Imf::HALF, kColor + 2},
                       {"B", Imf::HALF, kColor + 4},
                       {"A", Imf::HALF, offsetof(Pixel, alpha)}});
    add(wanted.depth, {{"Z", Imf::FLOAT, offsetof(Pixel, depth)}});
    add(wanted.albedo, {{"albedo.R", Imf::HALF, kAlbedo},
                        {"albedo.G", Imf::HALF, kAlbedo + 2},
                        {"albedo.B", Imf::HALF, kAlbedo + 4}});
    add(wanted.normal, {{"N.X", Imf::FLOAT, kNormal},
                        {"N.Y", Imf::FLOAT, kNormal + 4},
                        {"N.Z", Imf::FLOAT, kNormal + 8},
                        {"N.W", Imf::FLOAT, kNormal + 12}});
    add(wanted.position, {{"P.X", Imf::FLOAT, kPosition},
                          {"P.Y", Imf::FLOAT, kPosition + 4},
                          {"P.Z", Imf::FLOAT, kPosition + 8},
                          {"P.W", Imf::FLOAT, kPosition + 12}});
    add(wanted.variance, {{"variance.R", Imf::FLOAT, offsetof(Pixel, variance)},
                          {"variance.G", Imf::FLOAT, offsetof(Pixel, variance) + 4},
                          {"variance.B", Imf::FLOAT, offsetof(Pixel, variance) + 8}});
    add(wanted.samples, {{"samples", Imf::UINT, offsetof(Pixel, samples)}});
    add(wanted.id, {{"objectid", Imf::UINT, offsetof(Pixel, id)}});
    add_layers(settings, places);
    if (wanted.cryptomatte) {
        add_mattes(kObjectMattes, offsetof(MattePixel, objects), places);
        add_mattes(kMaterialMattes, offsetof(MattePixel, materials), places);
    }
    return places;
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
    for (const ChannelPlace& place : places_of(settings))
        header.channels().insert(place.name, Imf::Channel(place.type));
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
    if (places_of(settings).empty())
        throw InputError("render.channels = []: an image needs at least one channel");
    packers_ = std::make_unique<Packers>(
        header_of(settings, window, info, description, camera, mattes), places_of(settings));
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
                      Imf::Slice::Make(place.type, records + place.offset, corner, tile.width(),
                                       tile.y1 - tile.y0, stride,
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
