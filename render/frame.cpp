// SPDX-License-Identifier: Apache-2.0
#include "render/frame.hpp"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "render/file/exr_writer.hpp"
#include "render/file/part_file.hpp"
#include "render/file/preview.hpp"
#include "render/picture_inside.hpp"
#include "render/tile/tile_image.hpp"
#include "render/tile/tiles.hpp"

namespace tesserae::render {
namespace {

/// How many tiles may be under way or wait for the writer: for each thread enough that a slow tile
/// at the head of the line does not starve the others, yet no more than half a million pixels
/// (30 MB) a thread.
std::size_t tiles_in_flight(int tile) {
    const int per_thread = std::clamp((1 << 19) / (tile * tile), 2, 16);
    return static_cast<std::size_t>(per_thread * tbb::this_task_arena::max_concurrency());
}

/// A tile under way.
struct Slot {
    Tile tile;
    TileImage image;
    PackedTile packed;
};

/// Of the tiles in the order of the source, half open.
struct TileRange {
    std::size_t begin = 0, end = 0;
};

/// Renders tiles on all threads.
/// @param pack(image)   on any thread; write(slot)   in the order of the source
template <class Pack, class Write>
void render_tiles(const FrameScene& scene, const Crop& window, int tile_size,
                  const TileRange& range, const std::atomic<bool>& stop, Pack&& pack,
                  Write&& write) {
    TileSource source(scene.slice(), window, tile_size);
    for (std::size_t i = 0; i < range.begin; ++i) source.next();
    std::size_t left = range.end - range.begin;

    // Tiles start and end in the order of the source, whatever thread renders them. A slot is free
    // again when its turn comes: the tiles under way are consecutive, and no more than the slots.
    // (The frame owns the slots, since the pipeline forgets what is under way when a stage throws.)
    std::vector<Slot> slots(tiles_in_flight(tile_size));
    std::size_t turn = 0;
    const auto next_tile = [&](tbb::flow_control& flow) -> Slot* {
        if (stop.load(std::memory_order_relaxed)) throw Stopped();
        std::optional<Tile> tile;
        if (left > 0) tile = source.next();
        if (!tile) {
            flow.stop();
            return nullptr;
        }
        --left;
        Slot& slot = slots[turn++ % slots.size()];
        slot.tile = *std::move(tile);
        return &slot;
    };
    const auto render = [&](Slot* slot) {
        slot->image = render_tile(scene, slot->tile, stop);
        slot->packed = pack(slot->image);
        return slot;
    };
    tbb::parallel_pipeline(
        slots.size(), tbb::make_filter<void, Slot*>(tbb::filter_mode::serial_in_order, next_tile) &
                          tbb::make_filter<Slot*, Slot*>(tbb::filter_mode::parallel, render) &
                          tbb::make_filter<Slot*, void>(tbb::filter_mode::serial_in_order,
                                                        [&](Slot* slot) { write(*slot); }));
}

/// The bytes of an image's file: the header, tiles in the order of the calls, and between them the
/// table that says where they are.
class ImageInMemory {
  public:
    explicit ImageInMemory(const TilePacker& packer)
        : bytes_(packer.file_header()), header_(bytes_.size()), offsets_(packer.tiles()) {}

    void write(const PackedTile& tile) {
        offsets_[tile.index] = bytes_.size();
        bytes_.append(tile.bytes.data(), tile.bytes.size());
    }
    std::string finished() {
        const std::size_t table = offsets_.size() * sizeof(std::uint64_t);
        std::memcpy(bytes_.data() + header_ - table, offsets_.data(), table);
        return std::move(bytes_);
    }

  private:
    std::string bytes_;
    std::size_t header_;
    std::vector<std::uint64_t> offsets_;  ///< by rows
};

/// Copies a tile's values into a picture.
void copy_values(const TileImage& tile, std::span<const ChannelPlace> places,
                 tesserae::Picture::Inside& picture) {
    for (std::size_t i = 0; i < places.size(); ++i) {
        const ChannelPlace& place = places[i];
        const auto [records, stride] = records_of(tile, place.record);
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) {
                const char* value = records + tile.index(x, y) * stride + place.offset;
                picture.value(i, x, y) = static_cast<float>(
                    value_of(place.type, reinterpret_cast<const unsigned char*>(value)));
            }
    }
}

/// A whole part is there that would be made of the same; another is an error, unless it is to be
/// replaced. A damaged one is made again.
bool is_part_done(const PartInfo& info, const std::filesystem::path& file, bool overwrite) {
    if (!std::filesystem::exists(file) || !damage_of_part(file).empty()) return false;
    if (read_part_info(file).goes_with(info)) return true;
    if (overwrite) return false;
    throw InputError(
        fmt::format("{}: is a part of another frame; choose another folder, or "
                    "--overwrite",
                    file.string()));
}

}  // namespace

FrameStats render_frame(const Picture& picture, const FrameInfo& info,
                        const std::filesystem::path& exr, const std::filesystem::path& preview,
                        const std::atomic<bool>& stop) {
    const Settings& settings = picture.settings;
    const Crop window = settings.window();
    const Channels& channels = settings.channels;
    const FrameScene scene(picture, channels.color || channels.light || !preview.empty());
    ExrWriter image(exr, settings, window, info, picture.camera, scene.camera(), picture.mattes);
    std::optional<Preview> small;
    if (!preview.empty()) small.emplace(window, settings, picture.overlay);
    FrameStats stats;
    render_tiles(
        scene, window, settings.tile, {0, SIZE_MAX}, stop,
        [&](const TileImage& tile) { return image.pack(tile); },
        [&](const Slot& slot) {
            image.write(slot.packed);
            if (small) small->add(slot.image);
            stats += slot.image.stats;
        });

    // The preview first: where the image exists, its preview does.
    if (small) small->write(preview);
    image.finish();
    return stats;
}

FrameInMemory render_in_memory(const Picture& picture, const FrameInfo& info,
                               const std::atomic<bool>& stop,
                               FunctionRef<void(std::uint64_t done, std::uint64_t of)> tell) {
    const Settings& settings = picture.settings;
    const Crop window = settings.window();
    const bool has_color = settings.channels.color;
    const FrameScene scene(picture, has_color || settings.channels.light);
    TilePacker packer(settings, window, info, picture.camera, scene.camera(), picture.mattes);
    const std::vector<ChannelPlace> places = channel_places(settings);
    FrameInMemory frame{std::make_shared<tesserae::Picture::Inside>(window, places), {}};
    std::optional<Preview>& small = frame.picture->preview;
    if (has_color) small.emplace(window, settings, picture.overlay);
    ImageInMemory image(packer);
    std::uint64_t done = 0;
    render_tiles(
        scene, window, settings.tile, {0, SIZE_MAX}, stop,
        [&](const TileImage& tile) { return packer.pack(tile); },
        [&](const Slot& slot) {
            image.write(slot.packed);
            copy_values(slot.image, places, *frame.picture);
            if (small) small->add(slot.image);
            frame.stats += slot.image.stats;
            tell(++done, packer.tiles());
        });
    frame.picture->image = image.finished();
    return frame;
}

std::optional<FrameStats> render_part(const Picture& picture, const FrameInfo& info,
                                      const FramePart& part, const std::filesystem::path& file,
                                      bool overwrite, const std::atomic<bool>& stop) {
    const Settings& settings = picture.settings;
    const Crop window = settings.window();
    const Camera camera(picture.camera, settings.width, settings.height);
    TilePacker packer(settings, window, info, picture.camera, camera, picture.mattes);
    const PartInfo about = {
        part, window, settings.sky, settings.preview_size, packer.tiles(), packer.file_header()};
    if (is_part_done(about, file, overwrite)) return {};

    const FrameScene scene(picture, true);
    PartWriter out(file, about);
    Preview small(window, settings, picture.overlay);
    FrameStats stats;
    const auto cut = [&](int number) {
        return static_cast<std::uint64_t>(number) * about.tiles /
               static_cast<std::uint64_t>(part.count);
    };
    render_tiles(
        scene, window, settings.tile, {cut(part.number - 1), cut(part.number)}, stop,
        [&](const TileImage& tile) { return packer.pack(tile); },
        [&](const Slot& slot) {
            out.write(slot.packed);
            small.add(slot.image);
            stats += slot.image.stats;
        });
    out.finish(small);
    return stats;
}

}  // namespace tesserae::render
