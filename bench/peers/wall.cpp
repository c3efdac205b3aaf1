// SPDX-License-Identifier: Apache-2.0
// A wall of boxes while it settles, when it has, and after a heavy ball has hit it: tesserae at its
// defaults in four dimensions beside Bullet at its own in three. See README.md.
//   wall COUNT REPEATS

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "bench/peers/engine.hpp"
#include "bench/thread_time.hpp"
#include "core/dynamics/step/settings.hpp"

namespace tesserae::bench {
namespace {

constexpr double kBallRadius = 1, kBallSpeed = 10;  ///< [m], [m/s]
constexpr double kBallMass = 100;                   ///< of a box
constexpr double kBallGap = 0.5;                    ///< to the wall until it is thrown [m]
constexpr int kFlight = 12;                         ///< steps in which it gets there

/// A part of a run. Its time is that of all its steps.
struct State {
    const char* name;
    int first, steps;
};
constexpr int kThrown = 1200;  ///< the step before which the ball is
constexpr State kStates[] = {
    {"settling", 0, 480}, {"settled", 960, 240}, {"hit", kThrown + kFlight, 240}};

struct Engine {
    std::string name;
    MakePeer make;
    int dimension, iterations;
};

/// The wall, and last the ball, which lies before it on the floor.
PeerScene wall_and_ball(int dimension, int count) {
    PeerScene scene = box_wall(dimension, count);
    const PeerKind box = scene.kinds[0];
    PeerKind ball;
    ball.radius = kBallRadius;
    ball.sides = Vec4::Constant(2 * kBallRadius);
    ball.mass = kBallMass * box.mass;
    scene.kinds.push_back(ball);
    scene.kind.push_back(1);
    scene.position.push_back({0, kBallRadius, 0.5 * box.sides.z() + kBallGap + kBallRadius, 0});
    return scene;
}

/// What one engine does in each state.
struct Measured {
    std::vector<double> times[std::size(kStates)];  ///< of a step, of every repeat [s]
    double overlap[std::size(kStates)] = {};        ///< deepest [m]
    double speed[std::size(kStates)] = {};  ///< mean of the boxes': way over time of the state
};

/// Mean distance of the boxes [m].
double way(const std::vector<Vec4>& from, const std::vector<Vec4>& to) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < from.size(); ++i) sum += (to[i] - from[i]).norm();
    return sum / static_cast<double>(from.size() - 1);
}

void run(const Engine& of, int count, Measured& measured) {
    const PeerScene scene = wall_and_ball(of.dimension, count);
    const std::unique_ptr<PeerEngine> engine = of.make(scene, of.iterations);
    int step = 0;
    for (std::size_t s = 0; s < std::size(kStates); ++s) {
        const State& state = kStates[s];
        for (; step < state.first; ++step) {
            if (step == kThrown) engine->set_velocity(scene.size() - 1, {0, 0, -kBallSpeed, 0});
            engine->step();
        }
        const std::vector<Vec4> start = engine->positions();
        double time = 0, overlap = 0;
        for (int i = 0; i < state.steps; ++i, ++step) {
            const double before = thread_time();
            engine->step();
            time += thread_time() - before;
            overlap = std::max(overlap, engine->penetration());
        }
        measured.times[s].push_back(time / state.steps);
        measured.overlap[s] = overlap;
        measured.speed[s] = way(start, engine->positions()) / (state.steps * kPeerStep);
    }
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void compare(int count, int repeats) {
    const Engine engines[] = {
        {"tesserae_default", make_tesserae_at_defaults, 4, PhysicsSettings{}.iterations},
        {kBulletName, make_bullet, 3, 10}};
    Measured measured[std::size(engines)];
    for (int repeat = 0; repeat < repeats; ++repeat)
        for (std::size_t i = 0; i < std::size(engines); ++i) run(engines[i], count, measured[i]);
    for (std::size_t s = 0; s < std::size(kStates); ++s)
        for (std::size_t i = 0; i < std::size(engines); ++i) {
            const Measured& m = measured[i];
            const double time = median(m.times[s]);
            const auto [least, most] = std::minmax_element(m.times[s].begin(), m.times[s].end());
            fmt::print("{},{},{},{:.3f},{:.0f},{:.3f},{:.3f},{:.2f}\n", count, kStates[s].name,
                       engines[i].name, 1e3 * time, 100 * (*most - *least) / time,
                       time / median(measured[1].times[s]), 1e3 * m.overlap[s], 1e3 * m.speed[s]);
        }
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae::bench;
    const int count = argc == 3 ? std::atoi(argv[1]) : 0;
    const int repeats = argc == 3 ? std::atoi(argv[2]) : 0;
    if (count < 20 || repeats < 1) {
        fmt::print(stderr, "usage: wall COUNT REPEATS\n");
        return 2;
    }
    try {
        fmt::print(
            "bodies,state,engine,ms_per_step,spread_percent,ratio_to_bullet,penetration_mm,"
            "mean_speed_mm_s\n");
        compare(count, repeats);
    } catch (const std::exception& error) {
        fmt::print(stderr, "wall: {}\n", error.what());
        return 1;
    }
    return 0;
}
