// SPDX-License-Identifier: Apache-2.0
#include "render/measure.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/file/file_writer.hpp"
#include "render/file/exr_writer.hpp"
#include "render/file/preview.hpp"
#include "render/tile/tile_image.hpp"
#include "render/tile/tiles.hpp"

namespace tesserae::render {
namespace {

namespace fs = std::filesystem;

/// So many tiles are looked at, so that their lists stay small.
constexpr std::size_t kMostTiles = 512;
/// Sides of a tile [pixels] and samples in it, at most, usual 32 and 16,384: what a plan waits for
/// at least is one such tile a thread.
constexpr int kMostSide = 64, kMostSamples = 1 << 15;
/// A file of this size tells what syncing costs.
constexpr double kMostSynced = 4e6;

class Watch {
  public:
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const double seconds = std::chrono::duration<double>(now - begin_).count();
        begin_ = now;
        return seconds;
    }

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Settings of a frame that costs less, and how many times as much the samples of the real one
/// cost.
struct Lighter {
    Settings settings;
    double times = 1;
};

/// Samples cost alike, so that some of them tell what all cost. A pixel's error falls with the root
/// of its samples: with a target that is as much larger it takes as many times fewer.
Lighter lighter(const Settings& settings) {
    Lighter less{settings};
    Settings& s = less.settings;
    s.tile = std::min(s.tile, kMostSide);
    const int most = std::max(1, kMostSamples / (s.tile * s.tile));
    if (settings.most_samples() <= most) return less;
    const double part = static_cast<double>(most) / settings.most_samples();
    s.samples = std::max(1, static_cast<int>(part * settings.samples));
    s.max_samples = most;
    less.times = static_cast<double>(settings.most_samples()) / s.most_samples();
    s.noise_target *= std::sqrt(less.times);
    return less;
}

/// Every so many of a frame's tiles; `all` counts them.
std::vector<Tile> some_tiles(const FrameScene& scene, const Settings& settings, std::size_t& all) {
    const Crop window = settings.window();
    const auto along = [&](int pixels) {
        return static_cast<std::size_t>((pixels + settings.tile - 1) / settings.tile);
    };
    all = along(window.x1 - window.x0) * along(window.y1 - window.y0);
    const std::size_t every = (all + kMostTiles - 1) / kMostTiles;
    TileSource source(scene.slice(), window, settings.tile);
    std::vector<Tile> tiles;
    std::size_t number = 0;
    while (std::optional<Tile> tile = source.next())
        if (number++ % every == every / 2) tiles.push_back(*std::move(tile));
    return tiles;
}

/// Numbers below `count` in an order of which every beginning is spread evenly.
std::vector<std::size_t> spread_order(std::size_t count) {
    const auto golden = [&](std::size_t i) {
        const double place = 0.6180339887498949 * static_cast<double>(i);
        return place - std::floor(place);
    };
    std::vector<std::size_t> order(count), rank(count);
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return golden(a) < golden(b); });
    // The i-th in time stands where the i-th multiple of the golden ratio does.
    for (std::size_t place = 0; place < count; ++place) rank[order[place]] = place;
    return rank;
}

/// What a file of so many bytes costs beside making them.
void write_and_remove(const fs::path& file, double bytes) {
    write_file(file, std::string(static_cast<std::size_t>(std::min(bytes, kMostSynced)), '\0'));
    fs::remove(file);
}

}  // namespace

FrameCost measure_frame(const Picture& whole, const FrameInfo& info, double seconds,
                        const fs::path& folder, const std::atomic<bool>& stop) {
    const Lighter less = lighter(whole.settings);
    const Settings& settings = less.settings;
    const Picture picture = {whole.bodies, whole.appearance, whole.materials, whole.camera,
                             whole.lights, settings,         whole.path,      whole.frame,
                             whole.next,   whole.last,       whole.mattes};
    FrameCost cost;
    Watch watch;
    const FrameScene scene(picture, true);
    const std::vector<Tile> tiles = some_tiles(scene, settings, cost.all);
    ExrWriter image(folder / "measured.exr", settings, settings.window(), info, picture.camera,
                    scene.camera(), picture.mattes);
    Preview small(settings.window(), settings);
    cost.before = watch.lap();

    const auto threads = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    const std::vector<std::size_t> order = spread_order(tiles.size());
    std::vector<TileImage> images(8 * threads);
    std::vector<PackedTile> packed(images.size());
    std::vector<double> rendering(images.size()), packing(images.size());
    double spent = 0, sum_of_costs = 0, sum_of_squares = 0;
    while (cost.rendered < tiles.size() && (cost.rendered == 0 || spent < seconds)) {
        // The first ones show how many the time is enough for.
        const double waves = cost.rendered == 0
                                 ? 1
                                 : (seconds - spent) / spent * static_cast<double>(cost.rendered) /
                                       static_cast<double>(threads);
        const auto most = threads * static_cast<std::size_t>(std::clamp(waves, 1.0, 8.0));
        const std::size_t count = std::min(most, tiles.size() - cost.rendered);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
            Watch own;
            images[i] = render_tile(scene, tiles[order[cost.rendered + i]], stop);
            rendering[i] = own.lap();
            packed[i] = image.pack(images[i]);
            packing[i] = own.lap();
        });
        const double lap = watch.lap();
        const auto sum = [&](const std::vector<double>& seconds_of) {
            return std::accumulate(seconds_of.begin(),
                                   seconds_of.begin() + static_cast<std::ptrdiff_t>(count), 0.0);
        };
        const double work = sum(rendering) + sum(packing);
        const double share = work > 0 ? sum(rendering) / work : 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double tile = rendering[i] * less.times + packing[i];
            sum_of_costs += tile, sum_of_squares += tile * tile;
        }
        spent += lap;
        cost.tiles += lap * (1 + share * (less.times - 1));
        for (std::size_t i = 0; i < count; ++i) {
            image.write(packed[i]);
            small.add(images[i]);
            cost.bytes += static_cast<double>(packed[i].bytes.size());
        }
        // One thread does this while the others render.
        cost.tiles += watch.lap() / static_cast<double>(threads);
        cost.rendered += count;
    }
    const double mean = sum_of_costs / static_cast<double>(cost.rendered);
    const double variance = sum_of_squares / static_cast<double>(cost.rendered) - mean * mean;
    if (mean > 0) cost.spread = std::sqrt(std::max(0.0, variance)) / mean;
    cost.bytes *= static_cast<double>(cost.all) / static_cast<double>(cost.rendered);
    small.write(folder / "measured.png");
    fs::remove(folder / "measured.png");
    write_and_remove(folder / "measured.bytes", cost.bytes);
    cost.after = watch.lap();
    return cost;
}

}  // namespace tesserae::render
