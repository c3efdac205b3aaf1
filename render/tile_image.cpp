#include "render/tile_image.hpp"

#include <algorithm>
#include <limits>

#include "core/error.hpp"
#include "render/film_list.hpp"
#include "render/sampler.hpp"

namespace tesserae::render {
namespace {

/// What is averaged over a pixel.
struct Filtered {
    Color color = Color::Zero();
    Color albedo = Color::Zero();
    double alpha = 0;
};

/// The largest finite half.
constexpr double kHalfMax = 65504;

Imath::half to_half(double v) {
    return Imath::half(static_cast<float>(std::clamp(v, -kHalfMax, kHalfMax)));
}

/// The rays of one tile, window by window of the size of a film list.
class TileRays {
  public:
    TileRays(const FrameScene& scene, const Tile& tile) : scene_(scene), tile_(tile) {}

    /// Makes ready for the pixels of a window.
    void enter(const Crop& window) { list_.fill(scene_.slice, tile_.candidates, window); }
    Pixel pixel(int x, int y);
    FrameStats stats;

  private:
    /// A view ray and the body that it meets, if any.
    struct View {
        Vec4 direction;
        std::optional<Surface> surface;
    };
    View first_surface(const Vec2& film);
    void add(const View& view, const SampleNumber& sample, Filtered& sum);

    const FrameScene& scene_;
    const Tile& tile_;
    FilmList list_;
};

TileRays::View TileRays::first_surface(const Vec2& film) {
    ++stats.view_rays;
    const Vec3 view = scene_.camera.ray_direction(film);
    const Vec4 world = scene_.camera.to_world({view.x(), view.y(), view.z(), 0});
    const Hit hit = list_.nearest(scene_.placed, view, world, scene_.picture.settings, stats);
    if (!hit) return {world, std::nullopt};
    return {world, scene_.shading.surface(hit, Vec4::Zero(), world)};
}

void TileRays::add(const View& view, const SampleNumber& sample, Filtered& sum) {
    if (view.surface) {
        sum.alpha += 1;
        sum.albedo += view.surface->albedo;
    }
    if (!scene_.wants_color) return;
    const Sampler sampler(sample.x, sample.y, sample.sample);
    const Color color = scene_.transport.radiance(view.surface, view.direction, sampler, stats);
    if (color.isFinite().all())
        sum.color += color;
    else
        stats.count_invalid(sample, 1);
}

void store(const std::optional<Surface>& surface, const FrameScene& scene, Pixel& pixel) {
    pixel.depth = std::numeric_limits<float>::infinity();
    pixel.id = 0;
    std::fill_n(pixel.normal, 4, 0.0f);
    std::fill_n(pixel.position, 4, 0.0f);
    if (!surface) return;
    const Vec4 position = surface->point + scene.camera.origin();
    for (int i = 0; i < 4; ++i) {
        pixel.normal[i] = static_cast<float>(surface->normal[i]);
        pixel.position[i] = static_cast<float>(position[i]);
    }
    pixel.depth = static_cast<float>(surface->distance);
    pixel.id = scene.placed.bodies[surface->body].id + 1;
}

Pixel TileRays::pixel(int x, int y) {
    const Settings& settings = scene_.picture.settings;
    const Channels& c = settings.channels;
    const bool filtered = scene_.wants_color || c.albedo;
    Pixel pixel;
    Filtered sum;
    const bool one = settings.samples == 1;
    if (one || c.depth || c.normal || c.position || c.id) {
        const View view = first_surface({x + 0.5, y + 0.5});
        store(view.surface, scene_, pixel);
        if (one) add(view, {y, x, 0}, sum);
    } else {
        store(std::nullopt, scene_, pixel);
    }
    if (!one && filtered)
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(settings.samples); ++i)
            add(first_surface(Vec2(x, y) + pixel_sample(x, y, i)), {y, x, i}, sum);

    const double weight = 1.0 / settings.samples;
    for (int i = 0; i < 3; ++i) {
        pixel.color[i] = to_half(weight * sum.color[i]);
        pixel.albedo[i] = to_half(weight * sum.albedo[i]);
    }
    pixel.alpha = to_half(weight * sum.alpha);
    return pixel;
}

}  // namespace

FrameScene::FrameScene(const Picture& p, bool color)
    : picture(p),
      camera(p.camera, p.settings.width, p.settings.height),
      placed(place_bodies(p, camera.origin())),
      slice(slice_bounds(placed, camera, p.settings.max_distance)),
      lights(p.lights, camera.origin()),
      shading(p, placed, lights),
      transport(p, placed, lights, shading),
      wants_color(color) {}

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
