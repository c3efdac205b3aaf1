#include "render/file/part_file.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>

#include "core/error.hpp"

namespace tesserae::render {
namespace {

/// Format: this text; a PartHeader; the EXR header; per tile its index by rows, the count of its
/// bytes and the bytes; an index of kNoMore; the preview's sums, all of them the part has touched
/// in runs of first, count, sums; kEnd. Numbers are little-endian.
constexpr std::array<char, 16> kMagic = {"tesserae tiles1"};
constexpr std::uint64_t kNoMore = ~std::uint64_t{0}, kEnd = 0x2e646e65;

struct PartHeader {
    std::int32_t number = 0, count = 0;
    std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    std::uint64_t tiles = 0;  ///< of the whole frame
    std::uint64_t header_bytes = 0;
};

template <class T>
void put(FileWriter& out, const T& value) {
    out.write(&value, sizeof value);
}

/// Reads a part from its beginning to its end.
class PartReader {
  public:
    explicit PartReader(const std::filesystem::path& path)
        : path_(path), in_(path, std::ios::binary), left_(0) {
        std::error_code error;
        left_ = std::filesystem::file_size(path, error);
        if (error) bad(error.message());
        if (get<std::array<char, 16>>() != kMagic) bad("it does not begin as one");
        const auto head = get<PartHeader>();
        info.part = {head.number, head.count};
        info.window = {head.x0, head.y0, head.x1, head.y1};
        info.tiles = head.tiles;
        info.exr_header = bytes<std::string>(head.header_bytes);
        if (head.number < 1 || head.number > head.count || head.x0 >= head.x1 ||
            head.y0 >= head.y1 || head.tiles > head.header_bytes / sizeof(std::uint64_t))
            bad("its numbers make no sense");
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
    void read_sums(Preview& preview) {
        for (auto first = get<std::uint64_t>(); first != kNoMore; first = get<std::uint64_t>()) {
            const auto count = get<std::uint64_t>();
            if (count > left_ / sizeof(Preview::Sum)) bad("it is cut off");
            std::vector<Preview::Sum> sums(count);
            take(sums.data(), count * sizeof(Preview::Sum));
            if (!preview.add_sums(first, sums)) bad("its preview does not fit");
        }
        if (get<std::uint64_t>() != kEnd || left_ != 0) bad("it does not end as one");
    }

    PartInfo info;

  private:
    [[noreturn]] void bad(const std::string& why) const {
        throw InputError(
            fmt::format("{}: not a whole part of a frame: {}; remove it and render "
                        "that part again",
                        path_.string(), why));
    }
    void take(void* to, std::uint64_t count) {
        if (count > left_) bad("it is cut off");
        left_ -= count;
        if (!in_.read(static_cast<char*>(to), static_cast<std::streamsize>(count)))
            bad("it cannot be read");
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

PartWriter::PartWriter(const std::filesystem::path& path, const PartInfo& info) : writer_(path) {
    const Crop& w = info.window;
    put(writer_, kMagic);
    put(writer_, PartHeader{info.part.number, info.part.count, w.x0, w.y0, w.x1, w.y1, info.tiles,
                            info.exr_header.size()});
    writer_.write(info.exr_header.data(), info.exr_header.size());
}

void PartWriter::write(const PackedTile& tile) {
    put(writer_, tile.index);
    put(writer_, std::uint64_t{tile.bytes.size()});
    writer_.write(tile.bytes.data(), tile.bytes.size());
}

void PartWriter::finish(const Preview& preview) {
    put(writer_, kNoMore);
    // A part has touched little of the whole: runs of what is not 0.
    const std::span<const Preview::Sum> sums = preview.sums();
    for (std::size_t i = 0; i < sums.size();) {
        std::size_t end = i;
        while (end < sums.size() && sums[end] != Preview::Sum{}) ++end;
        if (end > i) {
            put(writer_, std::uint64_t{i});
            put(writer_, std::uint64_t{end - i});
            writer_.write(&sums[i], (end - i) * sizeof(Preview::Sum));
        }
        i = end + 1;
    }
    put(writer_, kNoMore);
    put(writer_, kEnd);
    writer_.finish();
}

PartInfo read_part_info(const std::filesystem::path& file) { return PartReader(file).info; }

void join_parts(std::span<const std::filesystem::path> parts, const std::filesystem::path& exr,
                const std::filesystem::path& preview) {
    const PartInfo first = read_part_info(parts.front());
    JoinedImage image(exr, first);
    Preview small(first.window, 0);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        PartReader part(parts[i]);
        if (!part.info.goes_with(first) || part.info.part.number != static_cast<int>(i) + 1 ||
            part.info.part.count != static_cast<int>(parts.size()))
            throw InputError(fmt::format("{}: is not part {} of {} of the frame of {}",
                                         parts[i].string(), i + 1, parts.size(),
                                         parts.front().string()));
        part.read_tiles([&](const PackedTile& tile) { image.write(tile); });
        part.read_sums(small);
    }
    if (!image.is_whole())
        throw InputError(fmt::format("{}: its parts lack tiles", parts.front().string()));
    // The preview first: where the image exists, its preview does.
    small.write(preview);
    image.finish();
}

}  // namespace tesserae::render
