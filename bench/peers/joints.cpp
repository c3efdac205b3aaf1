// SPDX-License-Identifier: Apache-2.0
// Ropes and nets of balls joined by points: tesserae in four dimensions beside Bullet in three, in
// one process on one thread, by turns. See README.md.
//   joints [SIDE]     of the net, usual 100

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <vector>

#include "bench/peers/jointed.hpp"
#include "bench/thread_time.hpp"

namespace tesserae::bench {
namespace {

constexpr int kStepsATurn = 6;
/// Iterations of this engine and of Bullet; the default, with which times are compared, is one.
const std::vector<int> kOwn = {5, 10, 100}, kBullets = {10, 30, 100};

/// An engine with one scene, and what is seen of it.
struct Run {
    const char* name;
    int iterations;
    std::unique_ptr<JointedEngine> engine;
    std::vector<double> seconds = {};  ///< of a step, by turns
    double error = 0;                  ///< largest of all steps [m]
    double start = 0;                  ///< energy at first [J]
    double least = 0, most = 0;        ///< energy of all steps, from that at first [J]
    double fall = 0;                   ///< largest loss of potential energy [J]
};

void take_turn(Run& run) {
    const double start_potential = run.start;  // all is at rest at first
    double time = 0;
    for (int i = 0; i < kStepsATurn; ++i) {
        const double begin = thread_time();
        run.engine->step();
        time += thread_time() - begin;
        run.error = std::max(run.error, run.engine->largest_error());
        const double change = run.engine->energy() - run.start;
        run.least = std::min(run.least, change), run.most = std::max(run.most, change);
        run.fall = std::max(run.fall, start_potential - run.engine->potential_energy());
    }
    run.seconds.push_back(time / kStepsATurn);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void measure(const JointedScene& scene, const char* load) {
    std::vector<Run> runs;
    for (const int iterations : kOwn)
        runs.push_back({"tesserae", iterations, jointed_in_tesserae(scene, iterations)});
    for (const int iterations : kBullets)
        runs.push_back({"bullet_double", iterations, jointed_in_bullet(scene, iterations)});
    for (Run& run : runs) run.start = run.engine->energy();
    for (int step = 0; step < scene.steps; step += kStepsATurn)
        for (Run& run : runs) take_turn(run);

    const double beside = median(runs[kOwn.size()].seconds);
    for (const Run& run : runs) {
        const double time = median(run.seconds);
        fmt::print("{},{},{},{},{},{},{},{:.4g},{:.3g},{:.3g},{:.3g},{:.3g}\n", scene.name, load,
                   run.name, run.iterations, scene.mass.size(), scene.links.size(), scene.steps,
                   1e3 * time, time / beside, run.error, 100 * run.most / run.fall,
                   100 * run.least / run.fall);
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae::bench;
    const int side = argc > 1 ? std::atoi(argv[1]) : 100;
    if (side < 2 || side > 300) {
        fmt::print(stderr, "usage: joints [SIDE]\n");
        return 2;
    }
    try {
        fmt::print(
            "scene,load,engine,iterations,bodies,joints,steps,ms_per_step,ratio_to_bullet,"
            "largest_error_m,energy_gained_percent,energy_lost_percent\n");
        measure(rope(20, 1, 960), "1");
        for (const double load : {1.0, 200.0, 1800.0})
            measure(rope(50, load, 960), fmt::format("{:g}", load).c_str());
        measure(net(10, 480), "");
        measure(net(side, 60), "");
    } catch (const std::exception& error) {
        fmt::print(stderr, "joints: {}\n", error.what());
        return 1;
    }
    return 0;
}
