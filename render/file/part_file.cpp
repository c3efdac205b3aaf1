// SPDX-License-Identifier: Apache-2.0
#include "render/file/part_file.hpp"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <memory>
#include <new>
#include <system_error>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "render/file/whole_image.hpp"

namespace tesserae::render {
namespace {

/// Format: this text; a PartHeader; the EXR header; per tile its index by rows, the count of its
/// bytes and the bytes; an index of kNoMore; the preview's sums, all of them the part has touched
/// in runs of first, count, sums; kNoMore; the count of the preview's stamps, and of each its
/// StampHeader and colours; the checksum of all bytes before it. Numbers are little-endian.
constexpr std::array<char, 16> kMagic = {"tesserae tiles4"};
constexpr std::uint64_t kNoMore = ~std::uint64_t{0};
/// As Settings allow it: along a side of a frame, in a tile.
constexpr int kMostPixels = 65536, kMostPixelsOfTile = 512 * 512;

struct PartHeader {
    std::int32_t number = 0, count = 0;
    std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    std::int32_t sky = 0, preview_size = 0;
    std::uint64_t tiles = 0;  ///< of the whole frame
    std::uint64_t header_bytes = 0;
};

struct StampHeader {
    std::int32_t x = 0, y = 0, width = 0, height = 0;
};

/// Of bytes in the order in which they are added. Finds what a disk or a network has changed, not
/// what somebody has forged.
class Checksum {
  public:
    Checksum() : state_(XXH3_createState()) {
        if (!state_) throw std::bad_alloc();
        XXH3_64bits_reset(state_.get());
    }
    void add(const void* bytes, std::size_t count) {
        XXH3_64bits_update(state_.get(), bytes, count);
    }
    std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

  private:
    struct Free {
        void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
    };
    std::unique_ptr<XXH3_state_t, Free> state_;
};

/// Reads a part from its beginning to its end.
class PartReader {
  public:
    explicit PartReader(const std::filesystem::path& path)
        : path_(path), in_(path, std::ios::binary), left_(0) {
        if (!in_) failed(errno);
        std::error_code error;
        left_ = std::filesystem::file_size(path, error);
        if (error) failed(error.value());
        if (get<std::array<char, 16>>() != kMagic) bad("it does not begin as one");
        const auto head = get<PartHeader>();
        info.part = {head.number, head.count};
        info.window = {head.x0, head.y0, head.x1, head.y1};
        info.sky = head.sky == 0 ? Sky::kOpaque : Sky::kTransparent;
        info.preview_size = head.preview_size;
        info.tiles = head.tiles;
        info.exr_header = bytes<std::string>(head.header_bytes);
        const bool is_window = 0 <= head.x0 && head.x0 < head.x1 && head.x1 <= kMostPixels &&
                               0 <= head.y0 && head.y0 < head.y1 && head.y1 <= kMostPixels;
        if (head.number < 1 || head.number > head.count || !is_window || head.sky < 0 ||
            head.sky > 1 || head.preview_size < 0 || head.preview_size > kMostPixels ||
            head.tiles > head.header_bytes / sizeof(std::uint64_t))
            bad("its numbers make no sense");
        const auto area = static_cast<std::uint64_t>(head.x1 - head.x0) *
                          static_cast<std::uint64_t>(head.y1 - head.y0);
        if (area / kMostPixelsOfTile > head.tiles) bad("its tiles do not cover the frame");
    }

    /// @param tile(PackedTile)   of every tile in order
    template <class Tile>
    void read_tiles(Tile&& tile) {
        for (auto index = get<std::uint64_t>(); index != kNoMore; index = get<std::uint64_t>()) {
            if (index >= info.tiles) bad("it has a tile that the frame has not");
            tile(PackedTile{index, bytes<std::vector<char>>(get<std::uint64_t>())});
        }
    }
    /// After the tiles.
    /// @param add(first, sums)   false if the preview has no such pixels
    template <class Add>
    void read_sums(Add&& add) {
        for (auto first = get<std::uint64_t>(); first != kNoMore; first = get<std::uint64_t>()) {
            const auto count = get<std::uint64_t>();
            if (count > left_ / sizeof(Preview::Sum)) bad("it is cut off");
            std::vector<Preview::Sum> sums(count);
            take(sums.data(), count * sizeof(Preview::Sum));
            if (!add(first, std::span<const Preview::Sum>(sums))) bad("its preview does not fit");
        }
    }
    /// After the sums; ends with the checksum.
    std::vector<Stamp> read_overlay() {
        std::vector<Stamp> stamps;
        for (auto left = get<std::uint64_t>(); left > 0; --left) {
            const auto head = get<StampHeader>();
            const bool is_small = 0 <= head.width && head.width <= kMostPixels &&
                                  0 <= head.height && head.height <= kMostPixels &&
                                  std::abs(static_cast<std::int64_t>(head.x)) <= kMostPixels &&
                                  std::abs(static_cast<std::int64_t>(head.y)) <= kMostPixels;
            if (!is_small) bad("its overlay makes no sense");
            const std::uint64_t count = std::uint64_t{4} * static_cast<unsigned>(head.width) *
                                        static_cast<unsigned>(head.height);
            stamps.push_back(
                {head.x, head.y, head.width, head.height, bytes<std::vector<std::uint8_t>>(count)});
        }
        const std::uint64_t expected = checksum_.value();
        if (get<std::uint64_t>() != expected) bad("its checksum is that of other bytes");
        if (left_ != 0) bad("it does not end as one");
        return stamps;
    }

    PartInfo info;

  private:
    [[noreturn]] void bad(const std::string& why) const {
        throw InputError(fmt::format("{}: not a whole part of a frame: {}", path_.string(), why));
    }
    /// The system's failure says nothing about the part.
    [[noreturn]] void failed(int error) const {
        throw RunError(fmt::format("{}: cannot be read: {}", path_.string(),
                                   std::generic_category().message(error)));
    }
    void take(void* to, std::uint64_t count) {
        if (count > left_) bad("it is cut off");
        left_ -= count;
        if (!in_.read(static_cast<char*>(to), static_cast<std::streamsize>(count))) {
            if (in_.eof()) bad("it is cut off");
            failed(errno);
        }
        checksum_.add(to, count);
    }
    template <class T>
    T get() {
        T value;
        take(&value, sizeof value);
        return value;
    }
    template <class T>
    T bytes(std::uint64_t count) {
        if (count > left_) bad("it is cut off");
        T text(count, '\0');
        take(text.data(), count);
        return text;
    }

    std::filesystem::path path_;
    std::ifstream in_;
    std::uint64_t left_;
    Checksum checksum_;
};

/// An EXR file of what others have compressed: the header, tiles in the order of the calls, and the
/// table that says where they are.
class JoinedImage {
  public:
    JoinedImage(const std::filesystem::path& path, const PartInfo& info)
        : writer_(path), table_(info.exr_header.size() - info.tiles * sizeof(std::uint64_t)) {
        offsets_.resize(info.tiles);
        writer_.write(info.exr_header.data(), info.exr_header.size());
    }

    void write(const PackedTile& tile) {
        offsets_[tile.index] = writer_.position();
        writer_.write(tile.bytes.data(), tile.bytes.size());
    }
    bool is_whole() const {
        return std::find(offsets_.begin(), offsets_.end(), 0) == offsets_.end();
    }
    void finish() {
        const std::uint64_t end = writer_.position();
        writer_.seek(table_);
        writer_.write(offsets_.data(), offsets_.size() * sizeof(std::uint64_t));
        writer_.seek(end);
        writer_.finish();
    }

  private:
    FileWriter writer_;
    std::uint64_t table_;
    std::vector<std::uint64_t> offsets_;  ///< by rows
};

}  // namespace

struct PartWriter::File {
    FileWriter writer;
    Checksum checksum;

    explicit File(const std::filesystem::path& path) : writer(path) {}

    void put_bytes(const void* bytes, std::size_t count) {
        writer.write(bytes, count);
        checksum.add(bytes, count);
    }
    template <class T>
    void put(const T& value) {
        put_bytes(&value, sizeof value);
    }
};

PartWriter::PartWriter(const std::filesystem::path& path, const PartInfo& info)
    : file_(std::make_unique<File>(path)) {
    const Crop& w = info.window;
    file_->put(kMagic);
    file_->put(PartHeader{info.part.number, info.part.count, w.x0, w.y0, w.x1, w.y1,
                          info.sky == Sky::kOpaque ? 0 : 1, info.preview_size, info.tiles,
                          info.exr_header.size()});
    file_->put_bytes(info.exr_header.data(), info.exr_header.size());
}

PartWriter::~PartWriter() = default;

void PartWriter::write(const PackedTile& tile) {
    file_->put(tile.index);
    file_->put(std::uint64_t{tile.bytes.size()});
    file_->put_bytes(tile.bytes.data(), tile.bytes.size());
}

void PartWriter::finish(const Preview& preview) {
    file_->put(kNoMore);
    // A part has touched little of the whole: runs of what is not 0.
    const std::span<const Preview::Sum> sums = preview.sums();
    for (std::size_t i = 0; i < sums.size();) {
        std::size_t end = i;
        while (end < sums.size() && sums[end] != Preview::Sum{}) ++end;
        if (end > i) {
            file_->put(std::uint64_t{i});
            file_->put(std::uint64_t{end - i});
            file_->put_bytes(&sums[i], (end - i) * sizeof(Preview::Sum));
        }
        i = end + 1;
    }
    file_->put(kNoMore);
    file_->put(std::uint64_t{preview.overlay().size()});
    for (const Stamp& stamp : preview.overlay()) {
        file_->put(StampHeader{stamp.x, stamp.y, stamp.width, stamp.height});
        file_->put_bytes(stamp.rgba.data(), stamp.rgba.size());
    }
    file_->put(file_->checksum.value());
    file_->writer.finish();
}

PartInfo read_part_info(const std::filesystem::path& file) { return PartReader(file).info; }

std::string damage_of_part(const std::filesystem::path& file) {
    try {
        PartReader part(file);
        part.read_tiles([](const PackedTile&) {});
        part.read_sums([](std::uint64_t, std::span<const Preview::Sum>) { return true; });
        part.read_overlay();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

bool is_made_of(const std::filesystem::path& exr, const PartInfo& info) {
    // The image's header begins as the part has it; its table of tiles is filled in.
    std::string header(info.exr_header.size() - info.tiles * sizeof(std::uint64_t), '\0');
    std::ifstream in(exr, std::ios::binary);
    in.read(header.data(), static_cast<std::streamsize>(header.size()));
    return in && info.exr_header.starts_with(header) && is_whole_image(exr);
}

void join_parts(std::span<const std::filesystem::path> parts, const std::filesystem::path& exr,
                const std::filesystem::path& preview) {
    const PartInfo first = read_part_info(parts.front());
    JoinedImage image(exr, first);
    // The sums are exposed already.
    Settings settings;
    settings.sky = first.sky, settings.preview_size = first.preview_size;
    Preview small(first.window, settings);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        PartReader part(parts[i]);
        if (!part.info.goes_with(first) || part.info.part.number != static_cast<int>(i) + 1 ||
            part.info.part.count != static_cast<int>(parts.size()))
            throw InputError(fmt::format("{}: is not part {} of {} of the frame of {}",
                                         parts[i].string(), i + 1, parts.size(),
                                         parts.front().string()));
        part.read_tiles([&](const PackedTile& tile) { image.write(tile); });
        part.read_sums([&](std::uint64_t begin, std::span<const Preview::Sum> sums) {
            return small.add_sums(begin, sums);
        });
        small.set_overlay(part.read_overlay());
    }
    if (!image.is_whole())
        throw InputError(fmt::format("{}: its parts lack tiles", parts.front().string()));
    // The preview first: where the image exists, its preview does.
    small.write(preview);
    image.finish();
}

}  // namespace tesserae::render
