// The stages of a step against the number of bodies and threads, in scenes of `tesserae generate`.
// One configuration a process, so that memory is its own. See README.md.
//   scaling SCENE BODIES THREADS [SETTLE STEPS]

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "parallel/parallel_world.hpp"
#include "parallel/threads.hpp"
#include "parallel/trace.hpp"
#include "scenes/generate.hpp"
#include "scenes/load/load.hpp"

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

void measure(const std::string& name, std::uint64_t count, int threads, int settle, int steps) {
    scenes::Scene scene = scene_of(name, count);
    const double before = usage().resident;
    const double dt = 1 / scene.physics->steps_per_second;
    parallel::ParallelWorld world(std::move(scene.bodies), *scene.physics);
    parallel::Trace trace;
    double wall = 0, cpu = 0, penetration = 0, contacts = 0;
    parallel::Threads(threads).run([&] {
        for (int i = 0; i < settle; ++i) world.step(dt);
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
    const auto row = [&](const std::string& quantity, double value) {
        fmt::print("{},{},{},{},{:.6g}\n", name, count, threads, quantity, value);
    };
    row("step_ms", 1e3 * wall / steps);
    for (const auto& [stage, seconds] : trace.seconds())
        if (stage != parallel::kIslandsSpan) row(stage + "_ms", 1e3 * seconds / steps);
    row("contacts", contacts);
    row("penetration_m", penetration);
    row("cpu_over_wall", cpu / wall);
    row("bytes_per_body", (usage().resident - before) / static_cast<double>(count));
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    if (argc != 4 && argc != 6) {
        fmt::print(stderr, "usage: scaling SCENE BODIES THREADS [SETTLE STEPS]\n");
        return 2;
    }
    fmt::print("scene,bodies,threads,quantity,value\n");
    tesserae::bench::measure(argv[1], std::strtoull(argv[2], nullptr, 10), std::atoi(argv[3]),
                             argc == 6 ? std::atoi(argv[4]) : 120,
                             argc == 6 ? std::atoi(argv[5]) : 20);
}
