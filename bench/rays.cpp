// Rays against random spheres and boxes at equal screen cover, one thread: millions of rays a
// second, as CSV. See README.md for the columns.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "bench/bodies.hpp"
#include "bench/thread_time.hpp"
#include "parallel/threads.hpp"
#include "render/film_list.hpp"
#include "render/ray_scene.hpp"
#include "render/shadow.hpp"
#include "render/tile_image.hpp"
#include "render/tiles.hpp"

namespace tesserae::bench {
namespace {

using namespace render;

constexpr int kSide = 512;
constexpr double kHalf = 5;           ///< of the cube of bodies [m]
constexpr double kBodiesOnRay = 1.5;  ///< that a ray through the whole cube meets on average

/// Spheres and boxes in turn, of about one size, turned at random, in a 4D cube in front of the
/// camera. A ray meets as many bodies whatever their number.
struct Cloud {
    Bodies bodies;
    std::vector<Appearance> appearance;
    std::vector<Material> materials = std::vector<Material>(1);
    CameraDescription camera;
    Lights lights;
    Settings settings;

    explicit Cloud(int count) {
        std::mt19937_64 random(1);
        std::uniform_real_distribution<> unit(-1, 1), factor(0.7, 1.4);
        // A ball of radius r shows a cross-section of 4/3 pi r^3 to a ray, a box of sides s on
        // average 2/(3 pi) of its boundary's content, which for a cube is 8 s^3.
        const double section = kBodiesOnRay * std::pow(2 * kHalf, 3) / count;
        const double radius = std::cbrt(section * 3 / (4 * kPi));
        const double side = std::cbrt(section * 3 * kPi / 16);
        for (int i = 0; i < count; ++i) {
            BodyType type = sphere_type(radius, 1, 0.5, 0);
            if (i % 2 == 1) {
                Vec4 sides;
                for (int k = 0; k < 4; ++k) sides[k] = side * factor(random);
                type.shape = Hyperbox{sides};
            }
            Vec4 x, u, v;
            for (int k = 0; k < 4; ++k) {
                x[k] = kHalf * unit(random);
                u[k] = 2 * unit(random), v[k] = 2 * unit(random);
            }
            const BodyId id = add(bodies, type, x);
            bodies.rotor[id] = exp(wedge(u, v));
        }
        appearance.resize(bodies.types.size());
        camera.position = {0, 0, -1.5 * kHalf, 0};
        lights.suns.push_back({Vec4(1, -2, 1, 0.5).normalized(), Color::Ones(), 1});
        settings.width = settings.height = kSide;
        settings.samples = 1;
    }
    Picture picture() const { return {bodies, appearance, materials, camera, lights, settings}; }
};

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

template <class F>
double time_of(F&& f) {
    std::vector<double> times;
    for (int i = 0; i < 5; ++i) {
        const double begin = thread_time();
        f();
        times.push_back(thread_time() - begin);
    }
    return median(times);
}

void measure(int count, Intersector intersector) {
    Cloud cloud(count);
    cloud.settings.intersector = intersector;
    const Picture picture = cloud.picture();
    const FrameScene scene(picture, true);

    std::vector<Surface> lit;
    FilmList list;
    FrameStats view_stats;
    const double view_time = time_of([&] {
        lit.clear();
        view_stats = {};
        TileSource source(scene.slice, {0, 0, kSide, kSide}, 32);
        while (const auto tile = source.next()) {
            for (int y0 = tile->y0; y0 < tile->y1; y0 += FilmList::kSide)
                for (int x0 = tile->x0; x0 < tile->x1; x0 += FilmList::kSide) {
                    const Crop window = {x0, y0, x0 + FilmList::kSide, y0 + FilmList::kSide};
                    list.fill(scene.slice, tile->candidates, window);
                    for (int y = window.y0; y < window.y1; ++y)
                        for (int x = window.x0; x < window.x1; ++x) {
                            const Vec3 view = scene.camera.ray_direction({x + 0.5, y + 0.5});
                            const Vec4 world =
                                scene.camera.to_world({view.x(), view.y(), view.z(), 0});
                            const Hit hit = list.nearest(scene.placed, view, world,
                                                         picture.settings, view_stats);
                            if (hit) lit.push_back(scene.shading.surface(hit, world));
                        }
                }
        }
    });
    const double views = kSide * kSide;

    const double build_time = time_of([&] { RayScene(scene.placed, picture.settings); });
    const RayScene rays(scene.placed, picture.settings);
    const SunDisc sun = sun_disc(cloud.lights.suns[0]);
    std::erase_if(lit, [&](const Surface& s) { return s.normal.dot(sun.toward) <= 0; });
    FrameStats hard_stats, bounce_stats, soft_stats;
    std::size_t hidden = 0, hits = 0;
    double light = 0;
    const double hard_time = time_of([&] {
        hidden = 0, hard_stats = {};
        for (const Surface& s : lit)
            hidden += rays.is_blocked(s.point, sun.toward, kMiss, s.body, hard_stats);
    });
    const Shadows shadows(scene.placed);
    const double soft_time = time_of([&] {
        light = 0, soft_stats = {};
        for (const Surface& s : lit) light += shadows.visibility(sun, s.point, s.body, soft_stats);
    });
    std::mt19937_64 random(2);
    std::normal_distribution<> normal;
    std::vector<Vec4> directions;
    for (const Surface& s : lit) {
        Vec4 d;
        for (int k = 0; k < 4; ++k) d[k] = normal(random);
        directions.push_back((s.normal + d.normalized()).normalized());
    }
    const double bounce_time = time_of([&] {
        hits = 0, bounce_stats = {};
        for (std::size_t i = 0; i < lit.size(); ++i)
            hits += rays.nearest(lit[i].point, directions[i], kMiss, lit[i].body, bounce_stats)
                        .distance < kMiss;
    });
    const double n = static_cast<double>(lit.size());
    const char* name = intersector == Intersector::kTrace ? "trace" : "analytic";
    const auto rate = [](double rays_traced, double time) { return 1e-6 * rays_traced / time; };
    const auto per = [](std::uint64_t evaluations, double of) {
        return static_cast<double>(evaluations) / of;
    };
    std::printf(
        "%s,%d,view+hard %.2f (eval %.2f) view %.2f hard %.2f soft %.2f bounce %.2f | eval view "
        "%.2f hard %.2f soft %.2f bounce %.2f | lit %.2f hidden %.2f light %.3f hits %.2f build "
        "%.2f ms\n",
        name, count, rate(views + n, view_time + hard_time),
        per(view_stats.distance_evaluations + hard_stats.distance_evaluations, views + n),
        rate(views, view_time), rate(n, hard_time), rate(n, soft_time), rate(n, bounce_time),
        per(view_stats.distance_evaluations, views), per(hard_stats.distance_evaluations, n),
        per(soft_stats.distance_evaluations, n), per(bounce_stats.distance_evaluations, n),
        n / views, static_cast<double>(hidden) / n, light / n, static_cast<double>(hits) / n,
        1e3 * build_time);
    std::fflush(stdout);
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae;
    std::vector<int> counts;
    for (int i = 1; i < argc; ++i) counts.push_back(std::atoi(argv[i]));
    if (counts.empty()) counts = {100, 1000, 10000, 100000};
    parallel::Threads threads(1);
    threads.run([&] {
        for (auto intersector : {render::Intersector::kAnalytic, render::Intersector::kTrace})
            for (int count : counts) bench::measure(count, intersector);
    });
}
