#include "render/tile_image.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>

#include "core/error.hpp"
#include "render/film_list.hpp"
#include "render/pixel_estimate.hpp"
#include "render/sampler.hpp"

namespace tesserae::render {
namespace {

/// Samples between two looks at a pixel's noise; and view rays that are traced together.
constexpr int kBatch = 16;
/// The group of a sample's numbers that the camera uses; scattering counts from 0.
constexpr std::uint32_t kCameraGroup = 0xffffffffu;
/// The largest finite half.
constexpr double kHalfMax = 65504;

Imath::half to_half(double v) {
    return Imath::half(static_cast<float>(std::clamp(v, -kHalfMax, kHalfMax)));
}

/// A view ray on its way into the scene.
struct View {
    const Instant* instant;
    ViewRay ray;
    Vec4 origin, direction;  ///< world axes, relative to the instant's camera
    std::optional<Surface> surface;

    View(const Instant& i, const ViewRay& r)
        : instant(&i),
          ray(r),
          origin(i.camera.to_world({r.origin.x(), r.origin.y(), r.origin.z(), r.fourth})),
          direction(i.camera.to_world({r.direction.x(), r.direction.y(), r.direction.z(), 0})) {}
};

/// What is averaged over a pixel's samples.
struct Filtered {
    PixelEstimate color;
    Color albedo = Color::Zero();
    double alpha = 0;
    int count = 0;
};

/// The rays of one tile, window by window of the size of a film list.
class TileRays {
  public:
    TileRays(const FrameScene& scene, const Tile& tile) : scene_(scene), tile_(tile) {}

    /// Makes ready for the pixels of a window.
    void enter(const Crop& window) { list_.fill(scene_.slice(), tile_.candidates, window); }
    Pixel pixel(int x, int y);
    FrameStats stats;

  private:
    using Cell = SliceSheet::Cell;

    View centre(const Cell& cell, int x, int y);
    /// Samples begin <= i < end, at most kBatch.
    void add_samples(const Cell& cell, int x, int y, int begin, int end, Filtered& sum);
    void trace(std::span<View> views);
    /// The views of a pixel's samples from `first` on.
    void add(std::span<const View> views, const SampleNumber& first, Filtered& sum);
    /// What comes along them: into colors_.
    void light(std::span<const View> views, const SampleNumber& first);

    const FrameScene& scene_;
    const Tile& tile_;
    FilmList list_;
    std::vector<View> views_;
    std::vector<ViewRay> rays_;
    std::vector<Hit> hits_;
    std::vector<LightTransport::Start> starts_;
    std::vector<Color> colors_;
};

void TileRays::trace(std::span<View> views) {
    stats.view_rays += views.size();
    const Settings& settings = scene_.picture().settings;
    hits_.resize(views.size());
    if (scene_.is_pinhole()) {
        for (std::size_t i = 0; i < views.size(); ++i)
            hits_[i] = list_.nearest(views[i].instant->placed, views[i].ray.direction,
                                     views[i].direction, settings, stats);
    } else if (scene_.is_still()) {
        rays_.clear();
        for (const View& view : views) rays_.push_back(view.ray);
        scene_.opening().view->nearest(rays_, hits_, stats);
    } else {
        for (std::size_t i = 0; i < views.size(); ++i)
            views[i].instant->view->nearest({&views[i].ray, 1}, {&hits_[i], 1}, stats);
    }
    for (std::size_t i = 0; i < views.size(); ++i)
        if (hits_[i])
            views[i].surface =
                views[i].instant->shading.surface(hits_[i], views[i].origin, views[i].direction);
}

View TileRays::centre(const Cell& cell, int x, int y) {
    const Instant& opening = scene_.opening();
    View view(opening, opening.rays.middle(cell, {x + 0.5, y + 0.5}));
    trace({&view, 1});
    return view;
}

void TileRays::add_samples(const Cell& cell, int x, int y, int begin, int end, Filtered& sum) {
    views_.clear();
    for (int i = begin; i < end; ++i) {
        const auto number = static_cast<std::uint32_t>(i);
        const Vec2 film = Vec2(x, y) + scene_.filter().place(pixel_sample(x, y, number));
        if (scene_.is_pinhole()) {
            views_.emplace_back(scene_.opening(), scene_.opening().rays.middle(cell, film));
            continue;
        }
        const auto u = Sampler(x, y, number).group(kCameraGroup);
        const Instant& instant = scene_.at(u[3]);
        views_.emplace_back(instant, instant.rays.sample(cell, film, {u[0], u[1], u[2]}));
    }
    trace(views_);
    add(views_, {y, x, static_cast<std::uint32_t>(begin)}, sum);
}

void TileRays::add(std::span<const View> views, const SampleNumber& first, Filtered& sum) {
    for (const View& view : views) {
        ++sum.count;
        if (!view.surface) continue;
        sum.alpha += 1;
        sum.albedo += view.surface->albedo;
    }
    if (!scene_.wants_color()) return;
    light(views, first);
    SampleNumber sample = first;
    for (const Color& color : colors_) {
        if (color.isFinite().all()) {
            sum.color.add(color);
        } else {
            sum.color.add(Color::Zero());
            stats.count_invalid(sample, 1);
        }
        ++sample.sample;
    }
}

void TileRays::light(std::span<const View> views, const SampleNumber& first) {
    starts_.clear();
    for (std::uint32_t i = 0; i < views.size(); ++i)
        starts_.push_back({views[i].surface ? &*views[i].surface : nullptr, views[i].origin,
                           views[i].direction, Sampler(first.x, first.y, first.sample + i)});
    colors_.resize(views.size());
    // Those of one instant together.
    for (std::size_t begin = 0, end; begin < views.size(); begin = end) {
        const Instant& instant = *views[begin].instant;
        end = begin + 1;
        while (end < views.size() && views[end].instant == &instant) ++end;
        instant.transport.radiance(std::span(starts_).subspan(begin, end - begin),
                                   std::span(colors_).subspan(begin, end - begin), stats);
    }
}

void store_view(const View& view, Pixel& pixel) {
    if (!view.surface) return;
    const Vec4 position = view.surface->point + view.instant->camera.origin();
    for (int i = 0; i < 4; ++i) {
        pixel.normal[i] = static_cast<float>(view.surface->normal[i]);
        pixel.position[i] = static_cast<float>(position[i]);
    }
    pixel.depth = static_cast<float>(view.surface->distance);
    pixel.id = view.instant->placed.bodies[view.surface->body].id + 1;
}

void store_filtered(const Filtered& sum, Pixel& pixel) {
    if (sum.count == 0) return;
    const Color variance = sum.color.variance();
    for (int i = 0; i < 3; ++i) {
        pixel.color[i] = to_half(sum.color.mean()[i]);
        pixel.albedo[i] = to_half(sum.albedo[i] / sum.count);
        pixel.variance[i] = static_cast<float>(variance[i]);
    }
    pixel.alpha = to_half(sum.alpha / sum.count);
    pixel.samples = static_cast<std::uint32_t>(sum.count);
}

Pixel TileRays::pixel(int x, int y) {
    const Settings& settings = scene_.picture().settings;
    const Channels& c = settings.channels;
    Pixel pixel = {};
    pixel.depth = std::numeric_limits<float>::infinity();
    const auto cell = scene_.sheet().cell_of(x, y);
    if (!cell) return pixel;

    const bool is_adaptive = settings.noise_target > 0 && scene_.wants_color();
    const int least = settings.samples;
    const int most = is_adaptive ? settings.most_samples() : least;
    Filtered sum;
    if (most == 1 || c.depth || c.normal || c.position || c.id) {
        const View view = centre(*cell, x, y);
        store_view(view, pixel);
        if (most == 1) add({&view, 1}, {y, x, 0}, sum);
    }
    if (most > 1 && (scene_.wants_color() || c.albedo || c.samples || c.variance)) {
        while (sum.count < least)
            add_samples(*cell, x, y, sum.count, std::min(sum.count + kBatch, least), sum);
        while (sum.count < most && sum.color.noise() > settings.noise_target)
            add_samples(*cell, x, y, sum.count, std::min(sum.count + kBatch, most), sum);
    }
    store_filtered(sum, pixel);
    return pixel;
}

}  // namespace

TileImage render_tile(const FrameScene& scene, const Tile& tile, const std::atomic<bool>& stop) {
    TileImage image = {tile.column, tile.row, tile.x0, tile.y0, tile.x1, tile.y1, {}, {}};
    const auto width = static_cast<std::size_t>(image.width());
    image.pixels.resize(width * static_cast<std::size_t>(tile.y1 - tile.y0));
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
                    image.pixels[static_cast<std::size_t>(y - tile.y0) * width +
                                 static_cast<std::size_t>(x - tile.x0)] = rays.pixel(x, y);
                }
        }
    image.stats = rays.stats;
    return image;
}

}  // namespace tesserae::render
