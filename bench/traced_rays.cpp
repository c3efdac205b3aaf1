// SPDX-License-Identifier: Apache-2.0
// Error and time of sphere tracing against its tolerance and against its limit of steps, beside the
// closed form: CSV on standard output. Exits with 1 if the loop measured is not the renderer's.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "bench/bodies.hpp"
#include "bench/thread_time.hpp"
#include "render/scene/intersect.hpp"

namespace tesserae::bench {
namespace {

using namespace render;

constexpr int kRays = 20'000;
constexpr double kDistance = 8;  ///< of the rays' origins from the body's centre [m]
constexpr int kRepeats = 3;
constexpr int kMostPlainSteps = 20'000;
constexpr int kMaxSteps = 200;                ///< the scene format's default
constexpr double kRendererTolerance = 1e-13;  ///< kOnSurface of render/scene/intersect.cpp
constexpr std::array<int, 9> kSteps = {1, 2, 3, 4, 6, 8, 16, 64, 200};

/// A body about the origin and rays toward it, of which some miss.
struct Target {
    Bodies bodies;
    std::vector<Appearance> appearance = std::vector<Appearance>(1);
    std::vector<Material> materials = std::vector<Material>(1);
    CameraDescription camera;
    Lights lights;
    Settings settings;
    Picture picture{bodies, appearance, materials, camera, lights, settings};
    PlacedBodies placed;
    std::vector<Ray> rays;
    std::vector<double> exact;  ///< distances [m]

    explicit Target(const Shape& shape) {
        BodyType type;
        type.shape = shape;
        add(bodies, type, Vec4::Zero());
        placed = place_bodies(picture, Vec4::Zero());
        std::mt19937_64 random(1);
        std::normal_distribution<> normal;
        const auto direction = [&] {
            return Vec4(normal(random), normal(random), normal(random), normal(random))
                .normalized();
        };
        std::uniform_real_distribution<> unit(0, 1);
        FrameStats stats;
        settings.intersector = Intersector::kAnalytic;
        for (int i = 0; i < kRays; ++i) {
            Vec4 origin = kDistance * direction();
            if (!is_bounded(shape)) origin.y() = std::abs(origin.y());
            // Uniform in a ball about the body that is a fifth wider.
            const double reach = is_bounded(shape) ? 1.2 * placed.bodies[0].radius : 2;
            const Vec4 aim = reach * std::pow(unit(random), 0.25) * direction();
            rays.push_back({origin, (aim - origin).normalized()});
            exact.push_back(hit_distance(placed, 0, rays.back(), settings, stats));
        }
        settings.intersector = Intersector::kTrace;
    }
    Target(const Target&) = delete;
};

/// The loop of render/scene/intersect.cpp with its tolerance as an argument; `is_plain` steps by
/// the distance alone, as sphere tracing is usually written.
template <class S>
double traced(const S& shape, const Ray& ray, double radius, double tolerance, bool is_plain,
              FrameStats& stats) {
    double t = 0, end = kMiss;
    if constexpr (S::kBounded) {
        const double middle = -ray.origin.dot(ray.direction);
        const double square = radius * radius - (ray.origin + middle * ray.direction).squaredNorm();
        if (!(square >= 0)) return kMiss;
        t = std::max(0.0, middle - std::sqrt(square));
        end = middle + std::sqrt(square);
        end += kRendererTolerance * end;
    }
    const double scale = ray.origin.norm();
    for (int step = 0; step < (is_plain ? kMostPlainSteps : kMaxSteps); ++step) {
        const Vec4 point = ray.origin + t * ray.direction;
        const double distance = signed_distance(shape, point);
        ++stats.distance_evaluations;
        if (distance <= tolerance * (scale + t)) return t;
        const double slope = is_plain ? -1 : normal(shape, point).dot(ray.direction);
        if (slope >= 0) return kMiss;
        t += std::max(distance, distance / -slope);
        if (t > end) return kMiss;
    }
    ++stats.unresolved;
    return t;
}

/// Traces all rays of a target and prints a row: errors of the distance over the rays that meet the
/// body, and the part of all rays that meet it only traced, or only in closed form.
template <class Trace>
std::vector<double> row(const Target& target, const std::string& experiment, const std::string& way,
                        double value, Trace&& trace) {
    std::vector<double> found(target.rays.size());
    FrameStats stats;
    double seconds = kMiss;
    for (int repeat = 0; repeat < kRepeats; ++repeat) {
        stats = {};
        const double begin = thread_time();
        for (std::size_t i = 0; i < found.size(); ++i) found[i] = trace(target.rays[i], stats);
        seconds = std::min(seconds, thread_time() - begin);
    }
    double square = 0, largest = 0;
    int met = 0, wrong = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const bool is_met = target.exact[i] < kMiss, is_found = found[i] < kMiss;
        wrong += is_met != is_found;
        if (!is_met || !is_found) continue;
        const double error = found[i] - target.exact[i];
        ++met, square += error * error;
        largest = std::max(largest, std::abs(error));
    }
    fmt::print("{},{},{},{:.3e},{:.3e},m,{:.5f},{:.1f},{:.2f}\n", experiment, way, value,
               std::sqrt(square / std::max(met, 1)), largest, wrong / double{kRays},
               1e9 * seconds / kRays, static_cast<double>(stats.distance_evaluations) / kRays);
    return found;
}

/// @return whether the loop at the renderer's tolerance finds what the renderer finds, to the bit
bool measure(const Shape& shape) {
    Target target(shape);
    const std::string name = name_of(shape);
    std::vector<double> renderers;
    for (const int steps : kSteps) {
        target.settings.max_steps = steps;
        renderers = row(target, "max_steps", name, steps, [&](const Ray& r, FrameStats& stats) {
            return hit_distance(target.placed, 0, r, target.settings, stats);
        });
    }
    target.settings.intersector = Intersector::kAnalytic;
    row(target, "closed form", name, 0, [&](const Ray& r, FrameStats& stats) {
        return hit_distance(target.placed, 0, r, target.settings, stats);
    });
    bool is_same = true;
    std::visit(
        [&](const auto& s) {
            for (const bool is_plain : {false, true}) {
                // Toward a plane a grazing ray's plain steps grow too slowly to arrive.
                if (is_plain && !s.kBounded) continue;
                for (const int power : {2, 3, 4, 6, 8, 10, 12, 13, 14}) {
                    const double tolerance = std::pow(10, -power);
                    const auto found = row(target, "tolerance", name + (is_plain ? " plain" : ""),
                                           tolerance, [&](const Ray& r, FrameStats& stats) {
                                               return traced(s, r, target.placed.bodies[0].radius,
                                                             tolerance, is_plain, stats);
                                           });
                    if (power == 13 && !is_plain) is_same = found == renderers;
                }
            }
        },
        shape);
    return is_same;
}

}  // namespace
}  // namespace tesserae::bench

int main() {
    using namespace tesserae;
    fmt::print("experiment,way,value,error,largest,unit,wrong,ns,steps\n");
    bool is_same = true;
    for (const Shape& shape :
         {Shape(Hypersphere{0.5}), Shape(Hypercapsule{0.3, 0.8}),
          Shape(Hyperbox{Vec4(0.5, 0.7, 0.9, 1.1)}), Shape(Hyperplane{Vec4::UnitY(), 0})})
        is_same = bench::measure(shape) && is_same;
    return is_same ? 0 : 1;
}
