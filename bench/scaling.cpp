// SPDX-License-Identifier: Apache-2.0
// The stages of a step against the number of bodies and threads, in scenes of `tesserae generate`.
// One scene a process, so that memory is its own; 1, 2, 4, ... threads start from the same settled
// state, one after the other. See README.md.
//   scaling SCENE BODIES THREADS SETTLE STEPS REPEATS

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"
#include "parallel/trace.hpp"
#include "scenes/generate/generate.hpp"
#include "scenes/load/load.hpp"
#include "scenes/process/memory.hpp"

namespace tesserae::bench {
namespace {

/// Of the process so far.
struct Usage {
    double cpu;       ///< [s]
    double resident;  ///< the most so far [bytes]
};
Usage usage() {
    rusage u;
    getrusage(RUSAGE_SELF, &u);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return {seconds(u.ru_utime) + seconds(u.ru_stime), 1024 * static_cast<double>(u.ru_maxrss)};
}

scenes::Scene scene_of(const std::string& name, std::uint64_t bodies) {
    const auto file = std::filesystem::temp_directory_path() /
                      fmt::format("scaling-{}-{}-{}.toml", name, bodies, getpid());
    std::ofstream(file) << scenes::generated_scene(name, bodies);
    scenes::Scene scene = scenes::load_scene(file, {});
    std::filesystem::remove(file);
    return scene;
}

/// Where a measurement starts.
struct State {
    Bodies bodies;
    StepMemory memory;
};

void row(const std::string& where, int threads, const std::string& quantity, double value) {
    fmt::print("{},{},{},{:.6g}\n", where, threads, quantity, value);
}

/// The state after some steps, and a row with the memory that they took.
State settled(const std::string& where, scenes::Scene& scene, int threads, int steps) {
    const double before = usage().resident, dt = 1 / scene.physics->steps_per_second;
    const auto count = static_cast<double>(scene.bodies.size());
    parallel::ParallelStepper world(std::move(scene.bodies), *scene.physics);
    parallel::Threads(threads).run([&] {
        for (int i = 0; i < steps; ++i) world.step(dt);
    });
    row(where, threads, "bytes_per_body", (usage().resident - before) / count);
    return {world.bodies(), world.memory()};
}

void measure(const std::string& where, const State& start, const PhysicsSettings& settings,
             double dt, int threads, int steps) {
    constexpr int kFirst = 2;  // find all pairs, and take memory
    parallel::ParallelStepper world(start.bodies, settings);
    world.memory() = start.memory;
    parallel::Trace trace;
    double wall = 0, cpu = 0, penetration = 0, contacts = 0;
    parallel::Threads(threads).run([&] {
        for (int i = 0; i < kFirst; ++i) world.step(dt);
        world.set_trace(&trace);
        const auto begin = std::chrono::steady_clock::now();
        const double cpu_begin = usage().cpu;
        for (int i = 0; i < steps; ++i) {
            const StepReport report = world.step(dt);
            penetration = std::max(penetration, report.penetration);
            contacts += static_cast<double>(report.contacts) / steps;
        }
        wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        cpu = usage().cpu - cpu_begin;
    });
    row(where, threads, "step_ms", 1e3 * wall / steps);
    for (const auto& [stage, seconds] : trace.seconds())
        if (stage != parallel::kIslandsSpan)
            row(where, threads, stage + "_ms", 1e3 * seconds / steps);
    row(where, threads, "contacts", contacts);
    row(where, threads, "penetration_m", penetration);
    row(where, threads, "cpu_over_wall", cpu / wall);
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae::bench;
    if (argc != 7) {
        fmt::print(stderr, "usage: scaling SCENE BODIES THREADS SETTLE STEPS REPEATS\n");
        return 2;
    }
    tesserae::scenes::return_large_memory();
    const int most = std::atoi(argv[3]);
    auto scene = scene_of(argv[1], std::strtoull(argv[2], nullptr, 10));
    const std::string where = fmt::format("{},{}", argv[1], argv[2]);
    fmt::print("scene,bodies,threads,quantity,value\n");
    const State start = settled(where, scene, most, std::atoi(argv[4]));
    for (int repeat = 0; repeat < std::atoi(argv[6]); ++repeat)
        for (int threads = 1; threads <= most; threads *= 2)
            measure(where, start, *scene.physics, 1 / scene.physics->steps_per_second, threads,
                    std::atoi(argv[5]));
}
