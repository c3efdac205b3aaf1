// SPDX-License-Identifier: Apache-2.0
// Times of a step beside Bullet's, the two in turn, and how the same scenes lie: a wall of boxes
// that settles, stands and is hit, and piles and heaps that have come down.

#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>

#include "bench/gate/gate.hpp"
#include "bench/peers/engine.hpp"
#include "bench/thread_time.hpp"

namespace tesserae::bench::gate {
namespace {

using Print = std::function<void(const std::vector<Row>&)>;

constexpr int kBulletIterations = 10;  ///< its default

std::unique_ptr<PeerEngine> make_here(const PeerScene& scene) {
    return make_tesserae_with(scene, PhysicsSettings{});
}
std::unique_ptr<PeerEngine> make_there(const PeerScene& scene) {
    return make_bullet(scene, kBulletIterations);
}

double time_of(PeerEngine& engine, int steps) {
    const double begin = thread_time();
    for (int i = 0; i < steps; ++i) engine.step();
    return (thread_time() - begin) / steps;
}

/// Mean distance of bodies [m].
double way(const std::vector<Vec4>& from, const std::vector<Vec4>& to) {
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i) sum += (to[i] - from[i]).norm();
    return sum / static_cast<double>(from.size());
}

/// The median, and the distance of the quartiles.
Row row_of(const std::string& name, const std::string& quantity, const std::string& unit,
           std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return {name,
            quantity,
            unit,
            values[n / 2],
            values[3 * n / 4] - values[n / 4],
            static_cast<int>(n),
            Better::kLess};
}

void add_times(std::vector<Row>& rows, const std::string& name, const std::string& when,
               const std::vector<double>& here, const std::vector<double>& there) {
    std::vector<double> ratios, ms;
    for (std::size_t i = 0; i < here.size(); ++i) {
        ratios.push_back(here[i] / there[i]);
        ms.push_back(1e3 * here[i]);
    }
    rows.push_back(row_of(name, "time of a step over Bullet's" + when, "ratio", ratios));
    rows.push_back(row_of(name, "time of a step" + when, "ms", ms));
}

// ---- piles and heaps ---------------------------------------------------------------------------

struct Settled {
    std::string name;
    PeerScene (*make)(int dimension, int count);
    int count, settling_steps, steps, repeats;
};

void measure(const Settled& of, bool quick, const Print& print) {
    const PeerScene scene = of.make(4, of.count), flat = of.make(3, of.count);
    const std::unique_ptr<PeerEngine> here = make_here(scene), there = make_there(flat);
    const int settling = of.settling_steps / (quick ? 2 : 1);
    std::thread other([&] { time_of(*there, settling); });
    time_of(*here, settling);
    other.join();

    std::vector<double> times_here, times_there;
    const std::vector<Vec4> start = here->positions();
    double overlap = 0;
    const int repeats = quick ? 3 : of.repeats;
    for (int i = 0; i < repeats; ++i) {
        times_here.push_back(time_of(*here, of.steps));
        times_there.push_back(time_of(*there, of.steps));
        overlap = std::max(overlap, here->penetration());
    }
    const double speed = way(start, here->positions()) / (repeats * of.steps * kPeerStep);
    std::vector<Row> rows;
    add_times(rows, of.name, "", times_here, times_there);
    rows.push_back(row_of(of.name, "deepest overlap", "mm", {1e3 * overlap}));
    rows.push_back(row_of(of.name, "mean speed of the bodies", "mm/s", {1e3 * speed}));
    print(rows);
}

const std::vector<Settled>& settled_scenes() {
    static const std::vector<Settled> scenes = {
        {"time: pile of 1000 spheres", sphere_pile, 1000, 960, 30, 9},
        {"time: heap of 1000 tumbled boxes", tumbled_boxes, 1000, 720, 20, 9},
        {"time: heap of 10000 tumbled boxes", tumbled_boxes, 10000, 480, 4, 9}};
    return scenes;
}

// ---- the wall ----------------------------------------------------------------------------------

constexpr const char* kWall = "time: wall of 1000 boxes";

/// What is measured in a run of the wall.
struct State {
    const char* name;
    int first, steps;
    bool hit;  ///< after the ball was thrown
};
struct Course {
    int thrown;  ///< the step before which the ball is
    std::vector<State> states;
};
/// @param part   of the full time in which the wall settles and stands
Course course_of(int part) {
    constexpr int kFlight = 12;  ///< steps in which the ball gets there
    const int thrown = 1200 / part;
    return {thrown,
            {{", settling", 0, 480 / part, false},
             {", settled", 960 / part, 240 / part, false},
             {", hit by a heavy ball", thrown + kFlight, 240 / part, true}}};
}

/// The wall of box_wall(), and last a ball of 100 times a box's mass before it.
PeerScene wall_and_ball(int dimension) {
    constexpr double kRadius = 1, kGap = 0.5;
    PeerScene scene = box_wall(dimension, 1000);
    PeerKind ball;
    ball.radius = kRadius;
    ball.sides = Vec4::Constant(2 * kRadius);
    ball.mass = 100 * scene.kinds[0].mass;
    scene.position.push_back({0, kRadius, 0.5 * scene.kinds[0].sides.z() + kGap + kRadius, 0});
    scene.kinds.push_back(ball);
    scene.kind.push_back(1);
    return scene;
}

/// What is measured in one of its states.
struct Measured {
    double time = 0;     ///< of a step [s]
    double overlap = 0;  ///< deepest [m]
    double speed = 0;    ///< mean of the bodies [m/s]
};

std::vector<Measured> run_wall(PeerEngine& engine, std::size_t ball, const Course& course) {
    std::vector<Measured> all;
    int step = 0;
    for (const State& state : course.states) {
        for (; step < state.first; ++step) {
            if (step == course.thrown) engine.set_velocity(ball, {0, 0, -10, 0});
            engine.step();
        }
        const std::vector<Vec4> start = engine.positions();
        Measured measured;
        for (int i = 0; i < state.steps; ++i, ++step) {
            measured.time += time_of(engine, 1) / state.steps;
            measured.overlap = std::max(measured.overlap, engine.penetration());
        }
        measured.speed = way(start, engine.positions()) / (state.steps * kPeerStep);
        all.push_back(measured);
    }
    return all;
}

void measure_wall(bool quick, const Print& print) {
    const PeerScene scene = wall_and_ball(4), flat = wall_and_ball(3);
    const std::size_t ball = scene.size() - 1;
    const Course course = course_of(quick ? 4 : 1);
    std::vector<std::vector<Measured>> here, there;
    for (int i = 0; i < (quick ? 1 : 5); ++i) {
        here.push_back(run_wall(*make_here(scene), ball, course));
        there.push_back(run_wall(*make_there(flat), ball, course));
    }
    std::vector<Row> rows;
    for (std::size_t s = 0; s < course.states.size(); ++s) {
        std::vector<double> times_here, times_there;
        for (std::size_t i = 0; i < here.size(); ++i) {
            times_here.push_back(here[i][s].time);
            times_there.push_back(there[i][s].time);
        }
        const std::string when = course.states[s].name;
        add_times(rows, kWall, when, times_here, times_there);
        rows.push_back(row_of(kWall, "deepest overlap" + when, "mm", {1e3 * here[0][s].overlap}));
        Row speed =
            row_of(kWall, "mean speed of the bodies" + when, "mm/s", {1e3 * here[0][s].speed});
        // How fast a wall falls is neither good nor bad.
        if (course.states[s].hit) speed.better = Better::kEqual;
        rows.push_back(speed);
    }
    print(rows);
}

}  // namespace

std::vector<std::string> timed_scenes() {
    std::vector<std::string> names{kWall};
    for (const Settled& scene : settled_scenes()) names.push_back(scene.name);
    return names;
}

void measure_times(const std::vector<std::string>& names, bool quick, const Print& print) {
    const auto asks_for = [&](const std::string& name) {
        return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    };
    if (asks_for(kWall)) measure_wall(quick, print);
    for (const Settled& scene : settled_scenes())
        if (asks_for(scene.name)) measure(scene, quick, print);
}

}  // namespace tesserae::bench::gate
