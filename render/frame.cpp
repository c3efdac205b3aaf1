#include "render/frame.hpp"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "render/file/exr_writer.hpp"
#include "render/file/preview.hpp"
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

}  // namespace

FrameStats render_frame(const Picture& picture, const FrameInfo& info,
                        const std::filesystem::path& exr, const std::filesystem::path& preview,
                        const std::atomic<bool>& stop) {
    const Settings& settings = picture.settings;
    const Crop window = settings.window();
    const Channels& channels = settings.channels;
    const FrameScene scene(picture, channels.color || channels.light || !preview.empty());
    TileSource source(scene.slice(), window, settings.tile);
    ExrWriter image(exr, settings, window, info, picture.camera, scene.camera(), picture.mattes);
    std::optional<Preview> small;
    if (!preview.empty()) small.emplace(window, settings.exposure);
    FrameStats stats;

    // Tiles start and end in the order of the source, whatever thread renders them. A slot is free
    // again when its turn comes: the tiles under way are consecutive, and no more than the slots.
    // (The frame owns the slots, since the pipeline forgets what is under way when a stage throws.)
    std::vector<Slot> slots(tiles_in_flight(settings.tile));
    std::size_t turn = 0;
    const auto next_tile = [&](tbb::flow_control& flow) -> Slot* {
        if (stop.load(std::memory_order_relaxed)) throw Stopped();
        std::optional<Tile> tile = source.next();
        if (!tile) {
            flow.stop();
            return nullptr;
        }
        Slot& slot = slots[turn++ % slots.size()];
        slot.tile = *std::move(tile);
        return &slot;
    };
    const auto render = [&](Slot* slot) {
        slot->image = render_tile(scene, slot->tile, stop);
        slot->packed = image.pack(slot->image);
        return slot;
    };
    const auto write = [&](Slot* slot) {
        image.write(slot->packed);
        if (small) small->add(slot->image);
        stats += slot->image.stats;
    };
    tbb::parallel_pipeline(
        slots.size(), tbb::make_filter<void, Slot*>(tbb::filter_mode::serial_in_order, next_tile) &
                          tbb::make_filter<Slot*, Slot*>(tbb::filter_mode::parallel, render) &
                          tbb::make_filter<Slot*, void>(tbb::filter_mode::serial_in_order, write));

    // The preview first: where the image exists, its preview does.
    if (small) small->write(preview);
    image.finish();
    return stats;
}

}  // namespace tesserae::render
