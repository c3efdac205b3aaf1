// SPDX-License-Identifier: Apache-2.0
// What steps of boxes cost while they settle, when they have, after a long rest, and after a heavy
// ball has hit them: tesserae at its defaults in four dimensions beside Bullet at its own in three.
// See README.md.
//   over_time SCENE COUNT REPEATS   box_wall, tumbled_boxes or box_pyramid

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
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

/// A scene and its parts.
struct Course {
    const char* name;
    PeerScene (*make)(int dimension, int count);
    std::vector<State> states;
};

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

std::vector<Course> all_courses() {
    return {{"box_wall",
             wall_and_ball,
             {{"settling", 0, 480}, {"settled", 960, 240}, {"hit", kThrown + kFlight, 240}}},
            {"tumbled_boxes",
             tumbled_boxes,
             {{"settling", 0, 480}, {"settled", 720, 240}, {"rested", 2400, 240}}},
            {"box_pyramid", box_pyramid, {{"settled", 720, 240}, {"rested", 2400, 240}}}};
}

/// What one engine does in one state.
struct Measured {
    std::vector<double> times;  ///< of a step, of every repeat [s]
    double overlap = 0;         ///< deepest [m]
    double speed = 0;           ///< mean of the boxes': way over time of the state
};

/// Mean distance of the first bodies [m].
double way(const std::vector<Vec4>& from, const std::vector<Vec4>& to, std::size_t count) {
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += (to[i] - from[i]).norm();
    return sum / static_cast<double>(count);
}

/// Measures every state of a course.
void run(const Engine& of, const Course& course, int count, std::vector<Measured>& measured) {
    const PeerScene scene = course.make(of.dimension, count);
    const bool has_ball = scene.kinds.size() > 1 && scene.kinds.back().radius > 0;
    const std::size_t boxes = scene.size() - has_ball;
    const std::unique_ptr<PeerEngine> engine = of.make(scene, of.iterations);
    int step = 0;
    for (std::size_t s = 0; s < course.states.size(); ++s) {
        const State& state = course.states[s];
        for (; step < state.first; ++step) {
            if (has_ball && step == kThrown) engine->set_velocity(boxes, {0, 0, -kBallSpeed, 0});
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
        measured[s].times.push_back(time / state.steps);
        measured[s].overlap = overlap;
        measured[s].speed = way(start, engine->positions(), boxes) / (state.steps * kPeerStep);
    }
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void compare(const Course& course, int count, int repeats) {
    const Engine engines[] = {
        {"tesserae_default", make_tesserae_at_defaults, 4, PhysicsSettings{}.iterations},
        {kBulletName, make_bullet, 3, 10}};
    std::vector<Measured> measured[std::size(engines)];
    for (std::vector<Measured>& of_engine : measured) of_engine.resize(course.states.size());
    for (int repeat = 0; repeat < repeats; ++repeat)
        for (std::size_t i = 0; i < std::size(engines); ++i)
            run(engines[i], course, count, measured[i]);
    for (std::size_t s = 0; s < course.states.size(); ++s)
        for (std::size_t i = 0; i < std::size(engines); ++i) {
            const Measured& m = measured[i][s];
            const double time = median(m.times);
            const auto [least, most] = std::minmax_element(m.times.begin(), m.times.end());
            fmt::print("{},{},{},{},{:.3f},{:.0f},{:.3f},{:.3f},{:.2f}\n", course.name, count,
                       course.states[s].name, engines[i].name, 1e3 * time,
                       100 * (*most - *least) / time, time / median(measured[1][s].times),
                       1e3 * m.overlap, 1e3 * m.speed);
        }
    std::fflush(stdout);
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae::bench;
    const std::vector<Course> courses = all_courses();
    const auto course = std::find_if(courses.begin(), courses.end(), [&](const Course& c) {
        return argc == 4 && std::string(c.name) == argv[1];
    });
    const int count = argc == 4 ? std::atoi(argv[2]) : 0;
    const int repeats = argc == 4 ? std::atoi(argv[3]) : 0;
    if (course == courses.end() || count < 20 || repeats < 1) {
        fmt::print(stderr,
                   "usage: over_time box_wall|tumbled_boxes|box_pyramid COUNT REPEATS\n"
                   "COUNT is at least 20, REPEATS at least 1\n");
        return 2;
    }
    try {
        fmt::print(
            "scene,bodies,state,engine,ms_per_step,spread_percent,ratio_to_bullet,penetration_mm,"
            "mean_speed_mm_s\n");
        compare(*course, count, repeats);
    } catch (const std::exception& error) {
        fmt::print(stderr, "over_time: {}\n", error.what());
        return 1;
    }
    return 0;
}
