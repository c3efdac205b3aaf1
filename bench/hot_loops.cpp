// SPDX-License-Identifier: Apache-2.0
// Time of the inner loops, by Google Benchmark. Every benchmark reports, as counters, nanoseconds
// for one item of its work or rays in a second; see README.md for the names.

#include <benchmark/benchmark.h>

#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "bench/bodies.hpp"
#include "bench/thread_time.hpp"
#include "core/contact/find_contacts.hpp"
#include "core/dynamics/solver/solver.hpp"
#include "core/dynamics/step/stage_copy.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/sort_and_sweep.hpp"
#include "parallel/threads.hpp"
#include "render/frame.hpp"

namespace tesserae::bench {
namespace {

using benchmark::Counter;
using benchmark::State;

/// Time of an iteration over its number of items.
void report_ns_per(State& state, const std::string& item, double items) {
    state.counters["ns_per_" + item] =
        Counter(1e-9 * items, Counter::kIsIterationInvariantRate | Counter::kInvert);
}

// ---- random input ----------------------------------------------------------------------------
constexpr int kInputs = 10000;

using Random = std::mt19937_64;

Vec4 random_direction(Random& random) {
    std::normal_distribution<> normal;
    Vec4 v;
    for (int i = 0; i < 4; ++i) v[i] = normal(random);
    return v.normalized();
}

std::vector<Rotor> random_rotors() {
    Random random(2);
    std::vector<Rotor> rotors;
    for (int i = 0; i < kInputs; ++i) {
        const Vec4 u = random_vector(random, 3), v = random_vector(random, 3);
        rotors.push_back(exp(wedge(u, v)));
    }
    return rotors;
}

// ---- algebra ---------------------------------------------------------------------------------
void rotor_product(State& state) {
    const std::vector<Rotor> rotors = random_rotors();
    for (auto _ : state)
        for (std::size_t i = 1; i < rotors.size(); ++i) {
            Rotor product = rotors[i] * rotors[i - 1];
            benchmark::DoNotOptimize(product);
        }
    report_ns_per(state, "product", kInputs - 1);
}
BENCHMARK(rotor_product);

void rotor_to_matrix(State& state) {
    const std::vector<Rotor> rotors = random_rotors();
    for (auto _ : state)
        for (const Rotor& rotor : rotors) {
            Mat4 matrix = to_matrix(rotor);
            benchmark::DoNotOptimize(matrix);
        }
    report_ns_per(state, "matrix", kInputs);
}
BENCHMARK(rotor_to_matrix);

// ---- shapes ----------------------------------------------------------------------------------
// Points within 3 m on each axis of a shape of about 1 m, rays towards it; how many hit is
// reported.

template <class S>
void signed_distance_of(State& state) {
    const S shape;
    Random random(3);
    std::vector<Vec4> points;
    for (int i = 0; i < kInputs; ++i) points.push_back(random_vector(random, 3));
    for (auto _ : state)
        for (const Vec4& point : points) benchmark::DoNotOptimize(signed_distance(shape, point));
    report_ns_per(state, "point", kInputs);
}
BENCHMARK(signed_distance_of<Hypersphere>);
BENCHMARK(signed_distance_of<Hypercapsule>);
BENCHMARK(signed_distance_of<Hyperbox>);
BENCHMARK(signed_distance_of<Hyperplane>);

template <class S>
void ray_hit_of(State& state) {
    const S shape;
    Random random(4);
    std::vector<std::array<Vec4, 2>> rays;
    for (int i = 0; i < kInputs; ++i) {
        const Vec4 origin = 3 * random_direction(random);
        rays.push_back({origin, (random_vector(random, 1.5) - origin).normalized()});
    }
    int hits = 0;
    for (const auto& [origin, direction] : rays) hits += ray_hit(shape, origin, direction) < kMiss;
    for (auto _ : state)
        for (const auto& [origin, direction] : rays)
            benchmark::DoNotOptimize(ray_hit(shape, origin, direction));
    report_ns_per(state, "ray", kInputs);
    state.counters["hit_percent"] = 100.0 * hits / kInputs;
}
BENCHMARK(ray_hit_of<Hypersphere>);
BENCHMARK(ray_hit_of<Hypercapsule>);
BENCHMARK(ray_hit_of<Hyperbox>);
BENCHMARK(ray_hit_of<Hyperplane>);

// ---- narrow phase ----------------------------------------------------------------------------
/// core's find_contacts() of a shape and a unit sphere at random places.
void pair_test(State& state, const Shape& other) {
    const Shape sphere = Hypersphere{1};
    Random random(5);
    std::vector<std::array<Vec4, 2>> pairs;
    for (int i = 0; i < kInputs; ++i)
        pairs.push_back({random_vector(random, 1.2), random_vector(random, 1.2)});
    const Vec4 origin = Vec4::Zero();
    const Rotor rotor;
    std::vector<Contact> contacts;
    for (auto _ : state) {
        contacts.clear();
        for (const auto& [a, b] : pairs)
            find_contacts(0, other, {is_bounded(other) ? a : origin, rotor}, 1, sphere, {b, rotor},
                          0, contacts);
        benchmark::DoNotOptimize(contacts.data());
    }
    report_ns_per(state, "pair", kInputs);
    state.counters["hit_percent"] = 100.0 * static_cast<double>(contacts.size()) / kInputs;
}
BENCHMARK_CAPTURE(pair_test, sphere_sphere, Hypersphere{1});
BENCHMARK_CAPTURE(pair_test, sphere_plane, Hyperplane{});

// ---- the heap --------------------------------------------------------------------------------
constexpr double kStep = 1.0 / 240;

/// Spheres after two seconds of falling: most of them rest on others.
struct Heap {
    Bodies bodies;
    StepMemory memory;
};

const Heap& heap_of(int count) {
    static std::map<int, Heap> heaps;
    const auto found = heaps.find(count);
    if (found != heaps.end()) return found->second;
    parallel::Threads threads(parallel::granted_cores());
    const int across = count < 1000 ? 4 : 8;
    parallel::ParallelStepper world(heap_of_spheres(count, across), PhysicsSettings{});
    threads.run([&] {
        for (int i = 0; i < 480; ++i) world.step(kStep);
    });
    return heaps[count] = {world.bodies(), world.memory()};
}

/// The next step of a heap as far as its islands.
struct StepBeforeSolver {
    Simulation simulation;
    StepData step;

    explicit StepBeforeSolver(const Heap& heap) {
        StageCopy found(Stage::kSolveIslands);
        parallel::ParallelStepper world(heap.bodies, PhysicsSettings{});
        world.memory() = heap.memory;
        world.observe(&found);
        parallel::Threads(1).run([&] { world.step(kStep); });
        simulation = found.simulation;
        step = found.step;
    }

    /// Processor time of all islands on one thread [s]. Does not change what the next call starts
    /// from.
    double solve(int iterations) {
        simulation.settings.iterations = iterations;
        simulation.settings.tolerance = 0;
        const auto velocity = step.velocity;
        const auto angular_velocity = step.angular_velocity;
        const auto impulses = step.impulses;
        const double begin = thread_time();
        for (std::size_t i = 0; i < step.islands.size(); ++i) solve_island(simulation, step, i);
        const double time = thread_time() - begin;
        step.velocity = velocity;
        step.angular_velocity = angular_velocity;
        step.impulses = impulses;
        step.has_rows.assign(step.islands.size(), 0);
        return time;
    }
};

/// One solver iteration of all contacts: the slope between 10 and 30 iterations.
void solver_iteration(State& state) {
    StepBeforeSolver stage(heap_of(static_cast<int>(state.range(0))));
    for (auto _ : state) {
        const double ten = stage.solve(10);
        state.SetIterationTime((stage.solve(30) - ten) / 20);
    }
    report_ns_per(state, "contact", static_cast<double>(stage.step.contacts.size()));
    state.counters["contacts"] = static_cast<double>(stage.step.contacts.size());
}
BENCHMARK(solver_iteration)->Arg(500)->Arg(4000)->UseManualTime()->Iterations(40);

/// Whole steps of the settled heap: spheres, threads.
void step_of_heap(State& state) {
    const Heap& heap = heap_of(static_cast<int>(state.range(0)));
    parallel::Threads threads(static_cast<int>(state.range(1)));
    parallel::ParallelStepper world(heap.bodies, PhysicsSettings{});
    world.memory() = heap.memory;
    threads.run([&] {
        world.step(kStep);
        for (auto _ : state) world.step(kStep);
    });
    report_ns_per(state, "body", static_cast<double>(state.range(0)));
}
BENCHMARK(step_of_heap)
    ->ArgsProduct({{500, 4000}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

// ---- broad phase -----------------------------------------------------------------------------
/// A search among spheres of one size all over a 4D cube, one thread.
void broad_phase(State& state) {
    const auto count = static_cast<int>(state.range(0));
    StageCopy found(Stage::kFindContacts);
    parallel::ParallelStepper world(cloud_of_spheres(count, 0.5, Vec4::Zero()), PhysicsSettings{});
    world.observe(&found);
    parallel::Threads(1).run([&] { world.step(kStep); });
    parallel::PairTable pairs;
    parallel::SortAndSweep sort_and_sweep;
    parallel::Threads threads(1);
    threads.run([&] {
        for (auto _ : state)
            sort_and_sweep.overlapping_pairs(found.simulation, found.step.bounds, pairs);
    });
    report_ns_per(state, "body", count);
    state.counters["pairs_per_body"] = static_cast<double>(pairs.size()) / count;
}
BENCHMARK(broad_phase)->RangeMultiplier(10)->Range(1000, 100000)->Unit(benchmark::kMillisecond);

// ---- frames ----------------------------------------------------------------------------------
/// A 512x512 frame of a cloud of spheres under a sun and a sky, one sample a pixel, default
/// channels, written to a file: spheres, threads.
void frame(State& state, render::Intersector intersector) {
    const auto count = static_cast<int>(state.range(0));
    // The cloud begins 1 m in front of the camera, whatever its size.
    const double half = std::pow(count, 0.25);
    const Bodies bodies = cloud_of_spheres(count, 1, Vec4(0, 0, half + 2, 0));
    const std::vector<render::Appearance> appearance(1);
    const std::vector<render::Material> materials(1);
    render::CameraDescription camera;
    camera.position = Vec4::Zero();
    camera.look_at = Vec4::UnitZ();
    render::Lights lights;
    lights.suns.push_back({Vec4(1, -2, 1, 0.5).normalized(), render::Color::Ones(), 1});
    lights.sky.setConstant(0.3);
    render::Settings settings;
    settings.width = settings.height = 512;
    settings.samples = 1;
    settings.intersector = intersector;
    const render::Picture picture{bodies, appearance, materials, camera, lights, settings};
    const auto file = std::filesystem::temp_directory_path() / "tesserae-bench.exr";
    const std::atomic<bool> stop = false;

    parallel::Threads threads(static_cast<int>(state.range(1)));
    render::FrameStats all;
    for (auto _ : state)
        threads.run([&] { all += render::render_frame(picture, {}, file, {}, stop); });
    std::filesystem::remove(file);
    state.counters["view_rays_per_s"] =
        Counter(static_cast<double>(all.view_rays), Counter::kIsRate);
    state.counters["shadow_rays_per_s"] =
        Counter(static_cast<double>(all.shadow_rays), Counter::kIsRate);
    state.counters["evaluations_per_ray"] = static_cast<double>(all.distance_evaluations) /
                                            static_cast<double>(all.view_rays + all.shadow_rays);
}
void arguments_of_frame(benchmark::internal::Benchmark* b) {
    b->ArgsProduct({{100, 1000, 10000}, {1, 2}})->UseRealTime()->Unit(benchmark::kMillisecond);
}
BENCHMARK_CAPTURE(frame, trace, render::Intersector::kTrace)->Apply(arguments_of_frame);
BENCHMARK_CAPTURE(frame, analytic, render::Intersector::kAnalytic)->Apply(arguments_of_frame);

}  // namespace
}  // namespace tesserae::bench
