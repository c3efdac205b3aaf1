// SPDX-License-Identifier: Apache-2.0
// Rays against random spheres and boxes, one thread: millions of rays a second as CSV, beside two
// yardsticks of the same run. See README.md for the columns.
//   rays [BODIES...]     by default 100, 1000, 10000, 100000
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bench/bodies.hpp"
#include "bench/thread_time.hpp"
#include "core/simd/simd.hpp"
#include "parallel/threads.hpp"
#include "render/light/shadow.hpp"
#include "render/scene/embree.hpp"
#include "render/scene/film_list.hpp"
#include "render/scene/ray_scene.hpp"
#include "render/scene/view_scene.hpp"
#include "render/tile/tile_image.hpp"

namespace tesserae::bench {
namespace {

using namespace render;

constexpr int kSide = 512;             ///< of the picture [pixels]
constexpr double kHalf = 5;            ///< of the cube of bodies [m]
constexpr double kMetOnAverage = 1.5;  ///< bodies that a ray through the whole cube enters
constexpr int kRepeats = 7;

/// Spheres and boxes in turn, of about one size, turned at random, in a 4D cube before the camera.
/// Their size shrinks with their number so that the picture is covered alike: some 80 %.
struct Cloud {
    Bodies bodies;
    std::vector<Appearance> appearance;
    std::vector<Material> materials = std::vector<Material>(1);
    CameraDescription camera;
    Lights lights;
    Settings settings;

    Cloud(int count, Intersector intersector) {
        std::mt19937_64 random(1);
        std::uniform_real_distribution<> unit(-1, 1), factor(0.7, 1.4);
        // Seen by a ray from anywhere a ball of radius r covers 4/3 pi r^3, a cube of side s
        // 2/(3 pi) of its boundary's content, 8 s^3.
        const double section = kMetOnAverage * std::pow(2 * kHalf, 3) / count;
        const double radius = std::cbrt(section * 3 / (4 * pi));
        const double side = std::cbrt(section * 3 * pi / 16);
        for (int i = 0; i < count; ++i) {
            BodyType type = sphere_type(radius, 1, 0.5, 0);
            Vec4 sides, x, u, v;
            for (int k = 0; k < 4; ++k) {
                sides[k] = side * factor(random);
                x[k] = kHalf * unit(random);
                u[k] = 2 * unit(random), v[k] = 2 * unit(random);
            }
            if (i % 2 == 1) type.shape = Hyperbox{sides};
            const BodyId id = add(bodies, type, x);
            bodies.rotor[id] = exp(wedge(u, v));
        }
        appearance.resize(bodies.types.size());
        camera.position = {0, 0, -1.5 * kHalf, 0};
        camera.look_at = Vec4::Zero();
        lights.suns.push_back({Vec4(1, -2, 1, 0.5).normalized(), Color::Ones(), 1});
        settings.width = settings.height = kSide;
        settings.samples = 1;
        settings.intersector = intersector;
    }
    Picture picture() const { return {bodies, appearance, materials, camera, lights, settings}; }
};

/// Median processor time [s] of the repeats, and the distance of their quartiles [%].
struct Time {
    double median, spread;
};
Time time_of(const std::function<void()>& work) {
    std::vector<double> times;
    for (int i = 0; i < kRepeats; ++i) {
        const double begin = thread_time();
        work();
        times.push_back(thread_time() - begin);
    }
    std::sort(times.begin(), times.end());
    const double median = times[kRepeats / 2];
    return {median, 100 * (times[3 * kRepeats / 4] - times[kRepeats / 4]) / median};
}

/// One kind of rays, measured.
struct Measured {
    Time time;
    double rays;
    FrameStats stats;
};

/// What the rates are compared with [million rays a second]: eight floats at a time, rays against
/// 1024 spheres without any hierarchy; and Embree's own spheres for the slices, the same view rays.
struct Yardsticks {
    double loop, embree;
};

/// The rates [million rays a second] of one intersector at one number of bodies, by kind of rays.
struct Rates {
    int bodies = 0;
    std::map<std::string, double> by_kind;
};

class Report {
  public:
    /// @param rates   of the last number of bodies; of this one in the end
    Report(const char* intersector, int bodies, const Yardsticks& y, Rates& rates)
        : intersector_(intersector), bodies_(bodies), yardsticks_(y), last_(rates), rates_(rates) {
        rates_ = {bodies, {}};
    }

    void row(const char* rays, const Measured& m) {
        const double rate = 1e-6 * m.rays / m.time.median;
        std::printf("%s,%d,%s,%.3g,%.1f,%.2f,%.3g,%.3g\n", intersector_, bodies_, rays, rate,
                    m.time.spread, static_cast<double>(m.stats.distance_evaluations) / m.rays,
                    rate / yardsticks_.loop, rate / yardsticks_.embree);
        std::fflush(stdout);
        rates_.by_kind[rays] = rate;
    }
    /// What the rates are to be divided by on another machine.
    void yardsticks() const {
        std::printf("%s,%d,loop,%.3g,,,1,\n%s,%d,embree_spheres,%.3g,,,,1\n", intersector_, bodies_,
                    yardsticks_.loop, intersector_, bodies_, yardsticks_.embree);
    }
    /// By what the time of a ray grew since the last number of bodies, over the growth of the
    /// number's logarithm: 1 where the time is proportional to it.
    void growth() const {
        for (const auto& [kind, rate] : last_.by_kind)
            std::printf(
                "%s,%d,growth_%s,%.3g,,,,\n", intersector_, bodies_, kind.c_str(),
                rate / rates_.by_kind.at(kind) * std::log(last_.bodies) / std::log(bodies_));
    }
    void build(const char* what, const Time& t) const {
        std::printf("%s,%d,%s,%.3g,%.1f,,,\n", intersector_, bodies_, what, 1e3 * t.median,
                    t.spread);
    }

  private:
    const char* intersector_;
    int bodies_;
    Yardsticks yardsticks_;
    Rates last_;
    Rates& rates_;
};

std::vector<ViewRay> view_rays(const Camera& camera) {
    std::vector<ViewRay> rays;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            ViewRay ray;
            ray.direction = camera.ray_direction({x + 0.5, y + 0.5});
            rays.push_back(ray);
        }
    return rays;
}

double loop_rate() {
    struct Spheres {
        simd::Float8 x, y, z, square;
    };
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<Spheres> spheres(128);
    for (Spheres& s : spheres)
        for (std::size_t i = 0; i < simd::kLanes; ++i)
            s.x[i] = unit(random), s.y[i] = unit(random), s.z[i] = 5 + unit(random),
            s.square[i] = 0.01f;
    constexpr int kRays = 4000;
    volatile std::uint32_t sink = 0;
    const Time time = time_of([&] {
        std::uint32_t met = 0;
        for (int r = 0; r < kRays; ++r) {
            const float x = 0.2f * unit(random), y = 0.2f * unit(random);
            for (const Spheres& s : spheres) {
                const simd::Float8 along = s.x * x + s.y * y + s.z;
                const simd::Float8 off = s.x * s.x + s.y * s.y + s.z * s.z - along * along;
                met += not_above(off, s.square);
            }
        }
        sink = met;
    });
    return 1e-6 * kRays / time.median;
}

double embree_rate(const FrameScene& scene) {
    const RTCDevice device = rtcNewDevice(nullptr);
    const RTCScene spheres = rtcNewScene(device);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT4, 4 * sizeof(float),
                                                               scene.slice().size()));
    for (const SliceBounds& s : scene.slice()) {
        for (int i = 0; i < 3; ++i) *vertex++ = static_cast<float>(s.centre[i]);
        *vertex++ = static_cast<float>(s.radius);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(spheres, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(spheres);
    const std::vector<ViewRay> rays = view_rays(scene.camera());
    const Time time = time_of([&] {
        RayContext context = ray_context();
        for (const ViewRay& r : rays) {
            RTCRayHit hit{};
            hit.ray.dir_x = static_cast<float>(r.direction.x());
            hit.ray.dir_y = static_cast<float>(r.direction.y());
            hit.ray.dir_z = static_cast<float>(r.direction.z());
            hit.ray.tfar = 200;
            hit.ray.mask = ~0u;
            hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            intersect(spheres, context, hit);
        }
    });
    rtcReleaseScene(spheres);
    rtcReleaseDevice(device);
    return 1e-6 * static_cast<double>(rays.size()) / time.median;
}

/// All view rays by the tiles' lists, with the surfaces that they meet in `surfaces`.
Measured through_lists(const FrameScene& scene, std::vector<Surface>& surfaces) {
    Measured m{{}, double{kSide} * kSide, {}};
    FilmList list;
    const auto trace_window = [&](const Tile& tile, int x0, int y0) {
        const Crop window = {x0, y0, x0 + FilmList::kSide, y0 + FilmList::kSide};
        list.fill(scene.slice(), tile.candidates, window);
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x) {
                const Settings& settings = scene.picture().settings;
                const Vec3 view = scene.camera().ray_direction({x + 0.5, y + 0.5});
                const Ray ray =
                    scene.camera().to_world(ViewRay{Vec3::Zero(), view}, settings.ray_limit());
                const Hit hit = list.nearest(scene.opening().placed, view, ray, settings, m.stats);
                if (hit) surfaces.push_back(scene.opening().shading.surface(hit, ray));
            }
    };
    m.time = time_of([&] {
        m.stats = {};
        surfaces.clear();
        TileSource source(scene.slice(), {0, 0, kSide, kSide}, scene.picture().settings.tile);
        while (const auto tile = source.next())
            for (int y = tile->y0; y < tile->y1; y += FilmList::kSide)
                for (int x = tile->x0; x < tile->x1; x += FilmList::kSide)
                    trace_window(*tile, x, y);
    });
    return m;
}

/// The same rays by the hierarchy for rays that do not start at one point.
Measured through_view_scene(const FrameScene& scene, std::size_t& hit_count) {
    Measured m{{}, double{kSide} * kSide, {}};
    const ViewScene view(scene.opening().placed, scene.camera(), scene.picture().settings, {}, 0);
    const std::vector<ViewRay> rays = view_rays(scene.camera());
    std::vector<Hit> hits(rays.size());
    m.time = time_of([&] {
        m.stats = {};
        view.nearest(rays, hits, m.stats);
    });
    hit_count = static_cast<std::size_t>(
        std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return bool(h); }));
    return m;
}

/// One ray from every lit surface.
template <class Trace>
Measured from_surfaces(const std::vector<Surface>& surfaces, Trace&& trace) {
    Measured m{{}, static_cast<double>(surfaces.size()), {}};
    volatile double sink = 0;
    m.time = time_of([&] {
        m.stats = {};
        double sum = 0;
        for (std::size_t i = 0; i < surfaces.size(); ++i)
            sum += static_cast<double>(trace(i, surfaces[i], m.stats));
        sink = sum;
    });
    return m;
}

/// Directions distributed by the cosine about the normals, as a path's are.
std::vector<Vec4> bounces(const std::vector<Surface>& surfaces) {
    std::mt19937_64 random(2);
    std::normal_distribution<> normal;
    std::vector<Vec4> directions;
    for (const Surface& s : surfaces) {
        Vec4 d;
        for (int k = 0; k < 4; ++k) d[k] = normal(random);
        directions.push_back((s.normal + d.normalized()).normalized());
    }
    return directions;
}

/// They start from the surfaces as the integrator's do, a pixel's first 16 samples at a time.
/// @param ask   of a block of rays, how many of them meet something
template <class Ask>
Measured by_sixteens(const std::vector<Surface>& surfaces, const std::vector<Vec4>& directions,
                     Ask&& ask) {
    constexpr std::size_t kTogether = 16;
    Measured m{{}, static_cast<double>(surfaces.size()), {}};
    std::vector<Ray> rays;
    volatile std::size_t sink = 0;
    m.time = time_of([&] {
        m.stats = {};
        std::size_t count = 0;
        for (std::size_t begin = 0; begin < surfaces.size(); begin += kTogether) {
            rays.clear();
            for (std::size_t i = begin; i < std::min(begin + kTogether, surfaces.size()); ++i)
                rays.push_back({surfaces[i].point, directions[i], surfaces[i].body});
            count += static_cast<std::size_t>(ask(rays, m.stats));
        }
        sink = count;
    });
    return m;
}

Measured bounced(const RayScene& scene, const std::vector<Surface>& surfaces) {
    std::vector<Hit> hits(16);
    return by_sixteens(surfaces, bounces(surfaces), [&](std::vector<Ray>& rays, FrameStats& stats) {
        scene.nearest(rays, std::span(hits).first(rays.size()), stats);
        return std::count_if(hits.begin(), hits.begin() + std::ssize(rays),
                             [](const Hit& hit) { return bool(hit); });
    });
}

Measured shaded(const RayScene& scene, const std::vector<Surface>& surfaces, const Vec4& toward) {
    std::vector<std::uint8_t> blocked(16);
    const std::vector<Vec4> directions(surfaces.size(), toward);
    return by_sixteens(surfaces, directions, [&](std::vector<Ray>& rays, FrameStats& stats) {
        scene.find_blocked(rays, std::span(blocked).first(rays.size()), stats);
        return std::count(blocked.begin(), blocked.begin() + std::ssize(rays), 1);
    });
}

void measure(int count, Intersector intersector, Rates& rates) {
    const Cloud cloud(count, intersector);
    const Picture picture = cloud.picture();
    const FrameScene scene(picture, true);
    Report report(intersector == Intersector::kTrace ? "trace" : "analytic", count,
                  {loop_rate(), embree_rate(scene)}, rates);
    report.yardsticks();
    std::vector<Surface> lit;
    const Measured view = through_lists(scene, lit);
    report.row("view", view);
    std::size_t hit_count = 0;
    report.row("view_scene", through_view_scene(scene, hit_count));
    if (hit_count != lit.size()) {
        std::fprintf(stderr, "lists meet %zu bodies, the hierarchy %zu\n", lit.size(), hit_count);
        std::exit(1);
    }

    const SunDisc sun = sun_disc(cloud.lights.suns[0]);
    std::erase_if(lit, [&](const Surface& s) { return s.normal.dot(sun.toward) <= 0; });
    const Interval& opening = scene.opening();
    const RayScene rays(opening.placed, opening.tree, picture.settings);
    const Shadows shadows(opening.placed, opening.tree);
    const Measured hard = shaded(rays, lit, sun.toward);
    report.row("hard", hard);
    Measured both = {
        {view.time.median + hard.time.median, std::max(view.time.spread, hard.time.spread)},
        view.rays + hard.rays,
        view.stats};
    both.stats += hard.stats;
    report.row("view_and_hard", both);
    report.row("soft", from_surfaces(lit, [&](std::size_t, const Surface& s, FrameStats& stats) {
                   return shadows.visibility(sun, s.point, s.body, stats);
               }));
    report.row("bounce", bounced(rays, lit));
    report.build("build_tree_ms", time_of([&] { BodyTree(scene.opening().placed); }));
    report.build("build_view_scene_ms", time_of([&] {
                     ViewScene(scene.opening().placed, scene.camera(), picture.settings, {}, 0);
                 }));
    report.growth();
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae;
    std::vector<int> counts;
    for (int i = 1; i < argc; ++i) counts.push_back(std::atoi(argv[i]));
    if (counts.empty()) counts = {100, 1000, 10000, 100000};
    std::puts(
        "intersector,bodies,rays,million_per_s,spread_percent,evaluations_per_ray,"
        "over_loop,over_embree_spheres");
    parallel::Threads threads(1);
    threads.run([&] {
        bench::Rates analytic, trace;
        for (const int count : counts) {
            bench::measure(count, render::Intersector::kAnalytic, analytic);
            bench::measure(count, render::Intersector::kTrace, trace);
        }
    });
}
