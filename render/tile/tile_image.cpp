// SPDX-License-Identifier: Apache-2.0
#include "render/tile/tile_image.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "render/integrator/integrator.hpp"
#include "render/sampling/sampler.hpp"
#include "render/scene/film_list.hpp"
#include "render/tile/adaptive.hpp"
#include "render/tile/sample_sums.hpp"

namespace tesserae::render {
namespace {

/// View rays that are traced together, with what comes along them: many, as side by side they take
/// less time, and while something moves only those of one interval go so.
constexpr int kBatch = 64;
/// The group of a sample's numbers that the camera uses; scattering counts from 0.
constexpr std::uint32_t kCameraGroup = 0xffffffffu;
/// The largest finite half.
constexpr double kHalfMax = 65504;

Imath::half to_half(double v) {
    return Imath::half(static_cast<float>(std::clamp(v, -kHalfMax, kHalfMax)));
}

/// A view ray and what it meets. Made in place: copies would wait for the numbers just written.
struct View {
    View(std::uint32_t sample, const Interval& i, const ViewRay& view_ray, const Ray& in_world)
        : number(sample), interval(&i), in_slice(view_ray), ray(in_world) {}

    std::uint32_t number;  ///< of the sample, in its half
    const Interval* interval;
    ViewRay in_slice;  ///< of the opening; of other times where ghosts are asked for
    Ray ray;
    bool is_met = false;
    Surface met;

    const Surface* surface() const { return is_met ? &met : nullptr; }
    Hit hit() const { return is_met ? Hit{met.distance, met.body} : Hit{}; }
};

/// A sample's numbers for lens, slice and time.
struct Draw {
    std::uint32_t number;
    std::array<double, 4> u;
};

/// Where a pixel's values go that are kept only where a channel asks for them; else null.
struct Extras {
    LayerPixel* layers = nullptr;
    MattePixel* mattes = nullptr;
};

/// Samples of a pixel with random numbers of one pattern. In reports of samples, those of a pixel
/// are counted with the halves in turn.
struct Half {
    std::uint64_t pattern;
    std::uint32_t first = 0, stride = 1;

    std::uint32_t number(std::uint32_t index) const { return first + stride * index; }
};

/// The rays of one tile, window by window of the size of a film list.
class TileRays {
  public:
    TileRays(const FrameScene& scene, const Tile& tile);

    /// Makes ready for the pixels of a window.
    void enter(const Crop& window) { list_.fill(scene_.slice(), tile_.candidates, window); }
    Pixel pixel(int x, int y, const Extras& extras);
    FrameStats stats;

  private:
    using Cell = SliceSheet::Cell;

    Averages adapted(const Cell& cell, int x, int y, const Extras& extras);
    Filtered empty_sum(std::size_t half);
    void add_samples(Filtered& sum, const Half& half, int count, const Cell& cell, int x, int y);
    // To views_:
    void add_centre(const Cell& cell, int x, int y);
    void add_samples_from_pinhole(const Cell& cell, int x, int y, std::uint64_t hash, int begin,
                                  int end);
    void add_samples_of_lens(const Cell& cell, int x, int y, std::uint64_t hash, int begin,
                             int end);
    void add_view(std::uint32_t number, const ViewRay& ray) {
        views_.emplace_back(number, scene_.opening(), ray, scene_.camera().to_world(ray, limit_));
    }
    // Of views_:
    void trace(bool is_opening);
    void trace_moving();
    void look_out_of_glass();
    template <class Use>
    void for_each_interval(Use&& use) const;
    void add_radiance(Filtered& sum, const Half& half, int x, int y);
    void find_radiance(const Sampler& sampler);
    void add_matte(const View& view, MatteSums& sums) const;
    void store_layers(const View& view, LayerPixel& layers) const;
    void store(const Averages& averages, int x, int y, Pixel& pixel, LayerPixel* layers);

    const FrameScene& scene_;
    const Tile& tile_;
    const Settings& settings_;
    double limit_;  ///< of rays [m]
    Half whole_;
    std::array<Half, 2> halves_;  ///< for adaptive sampling
    int least_, most_;            ///< samples of a pixel
    bool wants_centre_, wants_samples_;
    const Ghosts* ghosts_ = nullptr;  ///< beside the pixel's slice, if they are drawn
    FilmList list_;
    std::vector<View> views_;  ///< the batch under way, what it meets, and the light along it
    std::vector<Draw> draws_;
    std::vector<ViewRay> slice_rays_;
    std::vector<Ray> rays_;
    std::vector<Hit> hits_;
    std::vector<GlassStart> starts_;  ///< empty where nothing is of glass
    std::vector<ViewSample> samples_;
    std::vector<Color> colors_, direct_;
    std::array<MatteSums, 3> mattes_;  ///< of the halves and, if they are mixed, of both
    PathWave wave_;
    CentreLayers layers_;
};

void store_view(const View& view, const Camera& camera, Pixel& pixel) {
    if (!view.is_met) return;
    const Vec4 position = view.met.point + camera.origin();
    for (int i = 0; i < 4; ++i) {
        pixel.normal[i] = static_cast<float>(view.met.normal[i]);
        pixel.position[i] = static_cast<float>(position[i]);
    }
    pixel.depth = static_cast<float>(view.met.distance);
    pixel.id = view.interval->placed.bodies[view.met.body].id + 1;
}

bool is_beyond_half(const Color& color) { return (color.abs() > kHalfMax).any(); }

void store_averages(const Averages& averages, Pixel& pixel) {
    for (int i = 0; i < 3; ++i) {
        pixel.color[i] = to_half(averages.color[i]);
        pixel.albedo[i] = to_half(averages.albedo[i]);
        pixel.variance[i] = static_cast<float>(averages.variance[i]);
    }
    pixel.alpha = to_half(averages.alpha);
    pixel.samples = static_cast<std::uint32_t>(averages.count);
}

}  // namespace

TileImage render_tile(const FrameScene& scene, const Tile& tile, const std::atomic<bool>& stop) {
    TileImage image = {tile.column, tile.row, tile.x0, tile.y0, tile.x1, tile.y1, {}, {}, {}, {}};
    image.pixels.resize(static_cast<std::size_t>(image.width()) *
                        static_cast<std::size_t>(tile.y1 - tile.y0));
    const Channels& channels = scene.picture().settings.channels;
    if (scene.picture().settings.has_layers())
        image.layers.resize(image.pixels.size(), CentreLayers::empty());
    if (channels.cryptomatte) image.mattes.resize(image.pixels.size());
    TileRays rays(scene, tile);
    constexpr int kSide = FilmList::kSide;
    for (int y0 = tile.y0; y0 < tile.y1; y0 += kSide)
        for (int x0 = tile.x0; x0 < tile.x1; x0 += kSide) {
            const Crop window = {x0, y0, std::min(x0 + kSide, tile.x1),
                                 std::min(y0 + kSide, tile.y1)};
            rays.enter(window);
            for (int y = window.y0; y < window.y1; ++y)
                for (int x = window.x0; x < window.x1; ++x) {
                    if (stop.load(std::memory_order_relaxed)) throw Stopped();
                    const std::size_t index = image.index(x, y);
                    Extras extras;
                    if (!image.layers.empty()) extras.layers = &image.layers[index];
                    if (!image.mattes.empty()) extras.mattes = &image.mattes[index];
                    image.pixels[index] = rays.pixel(x, y, extras);
                }
        }
    image.stats = rays.stats;
    return image;
}

namespace {

Pixel TileRays::pixel(int x, int y, const Extras& extras) {
    Pixel pixel = {};
    pixel.depth = std::numeric_limits<float>::infinity();
    const auto cell = scene_.sheet().cell_of(x, y);
    if (!cell) return pixel;
    ghosts_ = scene_.ghosts(*cell);

    Filtered sum = empty_sum(0);
    if (wants_centre_) {
        views_.clear();
        add_centre(*cell, x, y);
        trace(true);
        store_view(views_.front(), scene_.camera(), pixel);
        if (extras.layers) store_layers(views_.front(), *extras.layers);
        if (most_ == 1) add_radiance(sum, whole_, x, y);
    }
    if (wants_samples_ && most_ > least_) {
        store(adapted(*cell, x, y, extras), x, y, pixel, extras.layers);
        return pixel;
    }
    if (wants_samples_) add_samples(sum, whole_, most_, *cell, x, y);
    if (sum.count > 0) store(averages_of(sum), x, y, pixel, extras.layers);
    if (sum.count > 0 && extras.mattes) *extras.mattes = sum.mattes->ranked(1.0 / sum.count);
    return pixel;
}

Filtered TileRays::empty_sum(std::size_t half) {
    Filtered sum;
    if (!settings_.channels.cryptomatte) return sum;
    sum.mattes = &mattes_[half];
    sum.mattes->clear();
    return sum;
}

void TileRays::store_layers(const View& view, LayerPixel& layers) const {
    const Surface* surface = view.surface();
    const BodyId body = surface ? view.interval->placed.bodies[surface->body].id : 0;
    layers_.store(view.ray, surface, body, layers);
}

void TileRays::add_matte(const View& view, MatteSums& sums) const {
    const Picture& picture = scene_.picture();
    const BodyId body = view.interval->placed.bodies[view.met.body].id;
    const std::uint32_t material = picture.appearance[picture.bodies.type[body]].material;
    sums.add(picture.mattes->objects[body], picture.mattes->materials[material]);
}

void TileRays::store(const Averages& averages, int x, int y, Pixel& pixel, LayerPixel* layers) {
    store_averages(averages, pixel);
    bool is_clamped = settings_.channels.color && is_beyond_half(averages.color);
    if (settings_.channels.light) {
        for (int i = 0; i < 3; ++i) {
            layers->direct[i] = to_half(averages.direct[i]);
            layers->indirect[i] = to_half(averages.indirect[i]);
        }
        is_clamped |= is_beyond_half(averages.direct) || is_beyond_half(averages.indirect);
    }
    if (ghosts_) {
        for (int i = 0; i < 3; ++i) layers->ghost[i] = to_half(averages.ghost.color[i]);
        layers->ghost[3] = to_half(averages.ghost.alpha);
    }
    if (is_clamped) stats.count_clamped({y, x, 0}, 1);
}

TileRays::TileRays(const FrameScene& scene, const Tile& tile)
    : scene_(scene),
      tile_(tile),
      settings_(scene.picture().settings),
      limit_(settings_.ray_limit()),
      whole_({scene.pattern()}),
      halves_({Half{scene.pattern(), 0, 2}, Half{second_pattern(scene.pattern()), 1, 2}}),
      least_(settings_.least_samples()),
      layers_(scene.picture(), scene.camera(), scene.sheet()) {
    const Channels& c = settings_.channels;
    most_ = scene.needs().more_samples && scene.wants_color() ? settings_.most_samples()
                                                              : settings_.samples;
    wants_centre_ = most_ == 1 || scene.needs().centre_rays;
    wants_samples_ = most_ > 1 && (scene.wants_color() || c.albedo || c.samples || c.variance ||
                                   c.cryptomatte || scene.needs().ghosts);
}

Averages TileRays::adapted(const Cell& cell, int x, int y, const Extras& extras) {
    std::array<Filtered, 2> sums = {empty_sum(0), empty_sum(1)};
    sample_adaptively(least_, most_, settings_.noise_target,
                      [&](std::size_t half, int count) -> const PixelEstimate& {
                          add_samples(sums[half], halves_[half], count, cell, x, y);
                          return sums[half].color;
                      });
    if (extras.mattes) {
        mattes_[2].clear();
        for (const Filtered& sum : sums) sum.mattes->add_to(mattes_[2], 0.5 / sum.count);
        *extras.mattes = mattes_[2].ranked(1);
    }
    return middle_of(averages_of(sums[0]), averages_of(sums[1]));
}

/// Samples of a half up to so many.
void TileRays::add_samples(Filtered& sum, const Half& half, int count, const Cell& cell, int x,
                           int y) {
    const std::uint64_t hash = pixel_hash(x, y, half.pattern);
    while (sum.count < count) {
        const int begin = sum.count, end = std::min(begin + kBatch, count);
        views_.clear();
        if (scene_.is_pinhole())
            add_samples_from_pinhole(cell, x, y, hash, begin, end);
        else
            add_samples_of_lens(cell, x, y, hash, begin, end);
        trace(scene_.is_still());
        add_radiance(sum, half, x, y);
    }
}

void TileRays::add_centre(const Cell& cell, int x, int y) {
    add_view(0, scene_.rays().middle(cell, {x + 0.5, y + 0.5}));
}

void TileRays::add_samples_from_pinhole(const Cell& cell, int x, int y, std::uint64_t hash,
                                        int begin, int end) {
    for (auto i = static_cast<std::uint32_t>(begin); i < static_cast<std::uint32_t>(end); ++i) {
        const Vec2 film = Vec2(x, y) + scene_.filter().place(pixel_sample(hash, i));
        add_view(i, scene_.rays().middle(cell, film));
    }
}

/// And through the open shutter: in the order of their times, so that those of an interval stand
/// together.
void TileRays::add_samples_of_lens(const Cell& cell, int x, int y, std::uint64_t hash, int begin,
                                   int end) {
    draws_.clear();
    for (auto i = static_cast<std::uint32_t>(begin); i < static_cast<std::uint32_t>(end); ++i)
        draws_.push_back({i, Sampler(hash, i).group(kCameraGroup)});
    if (!scene_.is_still())
        std::sort(draws_.begin(), draws_.end(), [](const Draw& a, const Draw& b) {
            return a.u[3] != b.u[3] ? a.u[3] < b.u[3] : a.number < b.number;
        });
    for (const Draw& draw : draws_) {
        const Vec2 film = Vec2(x, y) + scene_.filter().place(pixel_sample(hash, draw.number));
        const std::array<double, 3> u = {draw.u[0], draw.u[1], draw.u[2]};
        if (scene_.is_still()) {
            add_view(draw.number, scene_.rays().sample(cell, film, u));
        } else {
            const double time = scene_.time(draw.u[3]);
            views_.emplace_back(draw.number, scene_.at(time),
                                ghosts_ ? scene_.rays().sample(cell, film, u) : ViewRay{},
                                scene_.view_ray(cell, film, u, time));
        }
    }
}

/// Calls use(interval, first view, end) for views of one interval after the other.
template <class Use>
void TileRays::for_each_interval(Use&& use) const {
    for (std::size_t begin = 0, end; begin < views_.size(); begin = end) {
        const Interval* interval = views_[begin].interval;
        end = begin + 1;
        while (end < views_.size() && views_[end].interval == interval) ++end;
        use(*interval, begin, end);
    }
}

void TileRays::trace(bool is_opening) {
    stats.view_rays += views_.size();
    hits_.resize(views_.size());
    if (!is_opening) {
        trace_moving();
    } else if (scene_.is_pinhole()) {
        for (std::size_t i = 0; i < views_.size(); ++i)
            hits_[i] = list_.nearest(views_[i].interval->placed, views_[i].in_slice.direction,
                                     views_[i].ray, settings_, stats);
    } else {
        slice_rays_.clear();
        for (const View& view : views_) slice_rays_.push_back(view.in_slice);
        scene_.view().nearest(slice_rays_, hits_, stats);
    }
    if (!scene_.opening().integrator->glass().is_empty()) look_out_of_glass();
    for (std::size_t i = 0; i < views_.size(); ++i)
        if ((views_[i].is_met = bool(hits_[i])))
            views_[i].interval->shading.find_surface(hits_[i], views_[i].ray, views_[i].met);
}

void TileRays::trace_moving() {
    rays_.clear();
    for (const View& view : views_) rays_.push_back(view.ray);
    for_each_interval([&](const Interval& interval, std::size_t begin, std::size_t end) {
        interval.integrator->scene().nearest(std::span(rays_).subspan(begin, end - begin),
                                             std::span(hits_).subspan(begin, end - begin), stats);
    });
}

/// What is met first by rays that begin inside glass, which the searches take for met at once.
void TileRays::look_out_of_glass() {
    starts_.clear();
    for (std::size_t i = 0; i < views_.size(); ++i) {
        const View& view = views_[i];
        const GlassBodies& glass = view.interval->integrator->glass();
        const std::uint32_t medium =
            glass.medium_at(view.ray.origin, view.interval->glass_about, view.ray.time);
        const bool is_inside = medium != GlassBodies::kNone;
        const GlassBodies::Event event = is_inside
                                             ? glass.next(medium, view.ray, stats)
                                             : GlassBodies::Event{glass.ruling(hits_[i], view.ray)};
        hits_[i] = event.hit;
        starts_.push_back({medium, event.is_exit});
    }
}

/// Of the views of the half's next samples.
void TileRays::add_radiance(Filtered& sum, const Half& half, int x, int y) {
    for (const View& view : views_) {
        ++sum.count;
        if (ghosts_) sum.ghost += ghosts_->along(view.in_slice, view.hit(), stats);
        if (!view.is_met) continue;
        sum.alpha += 1;
        sum.albedo += view.met.albedo;
        if (sum.mattes) add_matte(view, *sum.mattes);
    }
    if (!scene_.wants_color()) return;
    find_radiance(Sampler(x, y, 0, half.pattern));
    for (std::size_t i = 0; i < colors_.size(); ++i) {
        if (colors_[i].isFinite().all()) {
            sum.color.add(colors_[i]);
            if (!settings_.channels.light) continue;
            sum.direct += direct_[i];
            sum.indirect += colors_[i] - direct_[i];
        } else {
            sum.color.add(Color::Zero());
            stats.count_invalid({y, x, half.number(views_[i].number)}, 1);
        }
    }
}

/// @param sampler   of any sample of the half
void TileRays::find_radiance(const Sampler& sampler) {
    samples_.clear();
    for (const View& view : views_)
        samples_.push_back({view.surface(), view.ray, sampler.of(view.number)});
    for (std::size_t i = 0; i < starts_.size(); ++i) samples_[i].start = starts_[i];
    colors_.resize(views_.size());
    if (settings_.channels.light) {
        direct_.resize(views_.size());
        for (std::size_t i = 0; i < samples_.size(); ++i) samples_[i].direct = &direct_[i];
    }
    for_each_interval([&](const Interval& interval, std::size_t begin, std::size_t end) {
        interval.integrator->radiance(std::span(samples_).subspan(begin, end - begin),
                                      std::span(colors_).subspan(begin, end - begin), wave_, stats);
    });
}

}  // namespace
}  // namespace tesserae::render
