// SPDX-License-Identifier: Apache-2.0
// How still piles of boxes stand after ten seconds, and what a step costs: tesserae by
// sweeps, sub-steps and steps a second beside Bullet and ODE by sweeps. See README.md.
//   rest [SCENE...]     board_stacks, box_wall, box_pyramid; default: all

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "bench/peers/engine.hpp"
#include "bench/thread_time.hpp"

namespace tesserae::bench {
namespace {

constexpr double kSeconds = 10;      ///< until the bodies are looked at
constexpr double kWatched = 0.5;     ///< the last of them, in which all is measured [s]
constexpr double kRepeat = 1 / 30.;  ///< what the time is the least of [s]

/// A point of a curve.
struct Way {
    std::string curve;  ///< the engine, and what is the same along the curve
    int dimension;
    double steps_per_second;
    int substeps, iterations;
    double tolerance;  ///< [m/s], 0 where an engine has none
    std::function<std::unique_ptr<PeerEngine>(const PeerScene&)> make;
};

Way way_of_tesserae(const std::string& curve, const PhysicsSettings& settings) {
    return {"tesserae" + curve,
            4,
            settings.steps_per_second,
            settings.substeps,
            settings.iterations,
            settings.tolerance,
            [=](const PeerScene& scene) { return make_tesserae_with(scene, settings); }};
}

std::vector<Way> all_ways() {
    std::vector<Way> ways;
    const double steps = 1 / kPeerStep;
    for (const int n : {5, 10, 20, 40, PhysicsSettings{}.iterations}) {
        ways.push_back({"bullet", 3, steps, 1, n, 0,
                        [n](const PeerScene& scene) { return make_bullet(scene, n); }});
        if (n <= 40)
            ways.push_back({"ode", 3, steps, 1, n, 0,
                            [n](const PeerScene& scene) { return make_ode(scene, n); }});
        PhysicsSettings settings;
        settings.iterations = n;
        ways.push_back(way_of_tesserae("", settings));
        settings.tolerance = 0;
        if (n <= 40) ways.push_back(way_of_tesserae(", all sweeps", settings));
    }
    for (const double rate : {60.0, 120.0, 480.0}) {
        PhysicsSettings settings;
        settings.steps_per_second = rate;
        ways.push_back(way_of_tesserae(", by steps", settings));
    }
    for (const int n : {1, 2})
        for (const int substeps : {2, 4, 8}) {
            PhysicsSettings settings;
            settings.iterations = n;
            settings.substeps = substeps;
            ways.push_back(way_of_tesserae(fmt::format(", sub-steps of {}", n), settings));
        }
    return ways;
}

/// Of the last half second.
struct Rest {
    double time = std::numeric_limits<double>::max();  ///< least, of kPeerStep simulated [s]
    double square_speed = 0;  ///< mean over bodies and steps of the way in a step over its length
    double fastest = 0;       ///< [m/s]
    double overlap = 0;       ///< the deepest that the engine found [m]
    double moved = 0;         ///< the farthest from where it was put, at the end [m]
};

Rest rest_of(const Way& way, const PeerScene& scene) {
    const std::unique_ptr<PeerEngine> engine = way.make(scene);
    const double h = 1 / way.steps_per_second;
    for (double t = 0; t < kSeconds - kWatched - 0.5 * h; t += h) engine->step();

    Rest rest;
    const int steps = static_cast<int>(std::lround(kWatched / h));
    const int steps_of_repeat = std::max(1, static_cast<int>(std::lround(kRepeat / h)));
    std::vector<Vec4> last = engine->positions();
    double time = 0;
    for (int i = 1; i <= steps; ++i) {
        const double before = thread_time();
        engine->step();
        time += thread_time() - before;
        if (i % steps_of_repeat == 0) {
            rest.time = std::min(rest.time, time / steps_of_repeat * (kPeerStep / h));
            time = 0;
        }
        const std::vector<Vec4> now = engine->positions();
        for (std::size_t k = 0; k < now.size(); ++k) {
            const double speed = (now[k] - last[k]).norm() / h;
            rest.square_speed += speed * speed / (steps * static_cast<double>(now.size()));
            rest.fastest = std::max(rest.fastest, speed);
        }
        rest.overlap = std::max(rest.overlap, engine->penetration());
        last = now;
    }
    for (std::size_t k = 0; k < last.size(); ++k)
        rest.moved = std::max(rest.moved, (last[k] - scene.position[k]).norm());
    return rest;
}

void measure(PeerScene (*make)(int dimension, int count), int count) {
    const PeerScene scenes[] = {make(3, count), make(4, count)};
    for (const Way& way : all_ways()) {
        const PeerScene& scene = scenes[way.dimension - 3];
        const Rest rest = rest_of(way, scene);
        fmt::print("{},{},\"{}\",{:g},{},{},{:g},{:.4g},{:.3g},{:.3g},{:.3g},{:.3g}\n", scene.name,
                   scene.size(), way.curve, way.steps_per_second, way.substeps, way.iterations,
                   way.tolerance, 1e3 * rest.time, 1e3 * std::sqrt(rest.square_speed),
                   1e3 * rest.fastest, 1e3 * rest.overlap, 1e3 * rest.moved);
        std::fflush(stdout);
    }
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae::bench;
    const std::vector<std::string> names(argv + 1, argv + argc);
    const auto is_asked = [&](const char* name) {
        return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    };
    try {
        fmt::print(
            "scene,bodies,curve,steps_per_second,substeps,iterations,tolerance,ms_per_240th,"
            "rms_speed_mm_s,fastest_mm_s,overlap_mm,moved_mm\n");
        if (is_asked("board_stacks")) measure(board_stacks, 30);
        if (is_asked("box_wall")) measure(box_wall, 140);
        if (is_asked("box_pyramid")) measure(box_pyramid, 105);
    } catch (const std::exception& error) {
        fmt::print(stderr, "rest: {}\n", error.what());
        return 1;
    }
    return 0;
}
