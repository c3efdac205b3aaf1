// SPDX-License-Identifier: Apache-2.0
// Error of pictures against samples and time: the integrators and the sampler on one scene, and
// the soft shadow of `direct` against traced light. CSV on standard output, with the columns of
// traced_rays; one thread.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "bench/bodies.hpp"
#include "bench/thread_time.hpp"
#include "render/scene/ray_scene.hpp"
#include "render/tile/tile_image.hpp"

namespace tesserae::bench {
namespace {

using namespace render;

constexpr int kWidth = 120, kHeight = 90;
constexpr int kReferenceSamples = 4096;
constexpr std::array<int, 9> kSamples = {1, 2, 4, 8, 16, 32, 64, 128, 256};

struct Scene {
    Bodies bodies;
    std::vector<Appearance> appearance;
    std::vector<Material> materials = std::vector<Material>(1);
    CameraDescription camera;
    Lights lights;
    Settings settings;

    Scene() {
        settings.width = kWidth, settings.height = kHeight;
        bodies.types.push_back(plane_type(Vec4::UnitY(), 0, 0, 0));
        add(bodies, 0u, Vec4::Zero());
        appearance.resize(1);
    }
    void add_body(const Shape& shape, const Vec4& position) {
        BodyType type;
        type.shape = shape;
        add(bodies, type, position);
        appearance.emplace_back();
    }
    Picture picture() const { return {bodies, appearance, materials, camera, lights, settings}; }
};

/// Spheres, capsules and boxes in and about the slice, on and above a floor that fills the picture.
Scene crowd() {
    Scene scene;
    std::mt19937_64 random(1);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * std::ldexp(static_cast<double>(random()), -64);
    };
    for (int i = 0; i < 90; ++i) {
        const double size = uniform(0.2, 0.45);
        const std::array<Shape, 3> shapes = {Hypersphere{size},
                                             Hypercapsule{0.6 * size, 1.5 * size},
                                             Hyperbox{size * Vec4(1.3, 1.6, 1.4, 1.5)}};
        const double x = uniform(-3, 3), y = uniform(size, 1.8), z = uniform(-3, 3);
        scene.add_body(shapes[static_cast<std::size_t>(i % 3)], {x, y, z, uniform(-0.6, 0.6)});
        if (i % 3 != 0) {
            const Vec4 u(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
            scene.bodies.rotor.back() = exp(wedge(Vec4::UnitY(), u));
        }
    }
    scene.camera.position = {1.8, 6.2, -8.2, 0}, scene.camera.look_at = {0, 0.5, 0.2, 0};
    scene.camera.field_of_view = 40;
    scene.lights.suns = {{Vec4(0.75, -1, 0.35, 0.1).normalized(), Color::Constant(2.7), 3}};
    scene.lights.sky = Color(0.25, 0.32, 0.45);
    return scene;
}

using Film = std::vector<Color>;

/// A turned camera draws the picture upside down, with other random numbers: turns it back.
CameraDescription turned(CameraDescription camera) {
    camera.up = -camera.up;
    return camera;
}
Film turned_back(const Film& film) { return {film.rbegin(), film.rend()}; }

/// What render_frame does but for its files.
Film rendered(const Scene& scene) {
    const Picture picture = scene.picture();
    const FrameScene frame(picture, true);
    TileSource source(frame.slice(), {0, 0, kWidth, kHeight}, scene.settings.tile);
    const std::atomic<bool> stop = false;
    Film film(kWidth * kHeight);
    while (const auto tile = source.next()) {
        const TileImage image = render_tile(frame, *tile, stop);
        for (int y = tile->y0; y < tile->y1; ++y)
            for (int x = tile->x0; x < tile->x1; ++x) {
                const auto& c = image.at(x, y).color;
                film[static_cast<std::size_t>(y * kWidth + x)] = Color(c[0], c[1], c[2]);
            }
    }
    return film;
}

struct Error {
    double mean_square_root = 0, largest = 0;  ///< in parts of the reference's mean
};
Error error_of(const Film& film, const Film& reference) {
    double square = 0, largest = 0, sum = 0;
    for (std::size_t i = 0; i < film.size(); ++i) {
        square += (film[i] - reference[i]).square().sum();
        largest = std::max(largest, (film[i] - reference[i]).abs().maxCoeff());
        sum += reference[i].sum();
    }
    const double count = 3.0 * static_cast<double>(film.size());
    return {std::sqrt(square / count) / (sum / count), largest / (sum / count)};
}

/// @param seconds   0 where no time was taken
void print_row(const std::string& experiment, const std::string& way, double value,
               const Error& error, double wrong = 0, double seconds = 0) {
    const std::string time =
        seconds > 0 ? fmt::format("{:.1f}", 1e9 * seconds / (kWidth * kHeight)) : "";
    fmt::print("{},{},{},{:.3e},{:.3e},mean,{:.5f},{},\n", experiment, way, value,
               error.mean_square_root, error.largest, wrong, time);
}

/// Whole pictures as the program renders them, each integrator against its own converged picture;
/// then how far `direct` is from `path`, which no number of samples mends.
void measure_integrators() {
    Scene scene = crowd();
    std::array<Film, 2> references;
    for (const bool is_path : {false, true}) {
        scene.settings.integrator = is_path ? Integrator::kPath : Integrator::kDirect;
        scene.settings.samples = kReferenceSamples;
        const CameraDescription camera = scene.camera;
        scene.camera = turned(camera);
        references[is_path] = turned_back(rendered(scene));
        scene.camera = camera;
        for (const int samples : kSamples) {
            scene.settings.samples = samples;
            const double begin = thread_time();
            const Film film = rendered(scene);
            const double seconds = thread_time() - begin;
            print_row("samples", is_path ? "path" : "direct", samples,
                      error_of(film, references[is_path]), 0, seconds);
        }
    }
    print_row("direct against path", "4 bounces", 0, error_of(references[0], references[1]));
}

/// Light along chosen rays, in double.
class Light {
  public:
    explicit Light(const Scene& scene)
        : picture_(scene.picture()),
          frame_(picture_, true),
          rays_(frame_.opening().placed, frame_.opening().tree, scene.settings) {}

    /// @param film      where on the film [pixels]
    /// @param sampler   of the light's random numbers
    Color along(const Vec2& film, const Sampler& sampler) {
        const Interval& opening = frame_.opening();
        const Ray ray = frame_.camera().to_world(frame_.rays().middle({0, 0, 0}, film), kMiss);
        const Hit hit = rays_.nearest(ray, stats_);
        const auto surface = hit ? std::optional(opening.shading.surface(hit, ray)) : std::nullopt;
        const ViewSample from = {surface ? &*surface : nullptr, ray, sampler};
        Color color;
        opening.integrator->radiance({&from, 1}, {&color, 1}, wave_, stats_);
        return color;
    }

  private:
    Picture picture_;
    FrameScene frame_;
    RayScene rays_;
    FrameStats stats_;
    PathWave wave_;
};

/// Means of a pixel's samples; independent ones are the first samples of as many pixels.
Film sampled(Light& light, int samples, bool is_stratified) {
    Film film;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            Color sum = Color::Zero();
            for (int i = 0; i < samples; ++i) {
                const int column = is_stratified ? x : x + kWidth * (i + 1);
                const auto index = static_cast<std::uint32_t>(is_stratified ? i : 0);
                sum += light.along(Vec2(x, y) + pixel_sample(column, y, index),
                                   Sampler(column, y, index));
            }
            film.push_back(sum / samples);
        }
    return film;
}

void measure_sampler() {
    Scene scene = crowd();
    scene.settings.integrator = Integrator::kPath;
    Scene other = scene;
    other.camera = turned(scene.camera);
    Light light(scene), turned_light(other);
    const Film reference = turned_back(sampled(turned_light, kReferenceSamples, true));
    for (const bool is_stratified : {true, false})
        for (const int samples : kSamples) {
            const double begin = thread_time();
            const Film film = sampled(light, samples, is_stratified);
            print_row("sampler", is_stratified ? "sobol" : "independent", samples,
                      error_of(film, reference), 0, thread_time() - begin);
        }
}

/// A ball over a floor under a sun of that half-angle, nothing else; it floats beside the slice, so
/// that only its shadow is seen. Errors are those of pixels in the penumbra, in parts of the open
/// floor's light; `wrong` is the part of pixels that lie there.
void measure_penumbra(double angle) {
    Scene scene;
    scene.add_body(Hypersphere{0.5}, {0, 1.2, 0, 0.6});
    scene.camera.position = {0, 4, -3, 0}, scene.camera.look_at = {0.6, 0, 0.24, 0};
    scene.camera.field_of_view = 28;
    scene.settings.bounces = 0;
    scene.lights.suns = {{Vec4(0.5, -1, 0.2, -0.4).normalized(), Color::Constant(4), angle}};
    Scene path = scene;
    path.settings.integrator = Integrator::kPath;
    Scene open = path;
    open.appearance.back().visible = false;

    Light direct_light(scene), path_light(path), open_light(open);
    constexpr int kLightSamples = 4096;
    constexpr std::array<int, 5> kFewer = {1, 4, 16, 64, 256};
    Error direct;
    std::array<double, kFewer.size()> squares = {}, largest = {};
    int count = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const Vec2 centre(x + 0.5, y + 0.5);
            const auto mean = [&](Light& light, int samples) {
                double sum = 0;
                for (int i = 0; i < samples; ++i)
                    sum += light.along(centre, Sampler(x, y, static_cast<std::uint32_t>(i)))[0];
                return sum / samples;
            };
            const double rough = mean(path_light, 64) / mean(open_light, 64);
            if (!(rough > 0.01 && rough < 0.99)) continue;
            const double lit = mean(open_light, kLightSamples);
            const double exact = mean(path_light, kLightSamples);
            const double error = (mean(direct_light, 1) - exact) / lit;
            ++count;
            direct.mean_square_root += error * error;
            direct.largest = std::max(direct.largest, std::abs(error));
            for (std::size_t k = 0; k < kFewer.size(); ++k) {
                const double of_path = (mean(path_light, kFewer[k]) - exact) / lit;
                squares[k] += of_path * of_path;
                largest[k] = std::max(largest[k], std::abs(of_path));
            }
        }
    const double part = count / double{kWidth * kHeight};
    direct.mean_square_root = std::sqrt(direct.mean_square_root / count);
    print_row("penumbra", "direct", angle, direct, part);
    for (std::size_t k = 0; k < kFewer.size(); ++k)
        print_row("penumbra", fmt::format("path of {}", kFewer[k]), angle,
                  {std::sqrt(squares[k] / count), largest[k]}, part);
}

}  // namespace
}  // namespace tesserae::bench

int main() {
    using namespace tesserae::bench;
    fmt::print("experiment,way,value,error,largest,unit,wrong,ns,steps\n");
    measure_integrators();
    measure_sampler();
    for (const double angle : {1.0, 5.0, 20.0}) measure_penumbra(angle);
}
