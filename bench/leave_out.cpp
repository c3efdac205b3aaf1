// SPDX-License-Identifier: Apache-2.0
// What leaving out saves: each scene twice, once needing a part by a negligible amount and once not
// at all, measured in turns. See README.md.
//   leave_out [NAME...]     default: all

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "bench/thread_time.hpp"
#include "core/dynamics/islands/islands.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/solver/solver.hpp"
#include "core/dynamics/step/stage_copy.hpp"
#include "core/dynamics/step/step.hpp"
#include "parallel/parallel_stepper.hpp"
#include "parallel/threads.hpp"
#include "scenes/film/film.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/load/load.hpp"

namespace tesserae::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kRepeats = 15, kSteps = 5;
constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();
constexpr double kSeconds = 1.0 / 240;  // of a step

/// One repeat. Returns its processor time [s].
using Work = std::function<double()>;

/// What of a scene is measured.
enum class Part {
    kStep,      ///< steps of its world, after some that settle it
    kIslands,   ///< the islands of one step: built and solved
    kColours,   ///< the same, all of them coloured against none
    kSimulate,  ///< the whole of `tesserae simulate`
    kFilm,      ///< the frames of `tesserae render`, but for the trajectory
};

struct Case {
    const char* name;
    const char* decision;  ///< of the plan: needed with, not without; empty if it has none
    Part part;
    int settle;  ///< steps before those that are measured
    std::string with, without;
};

// Scenes are text, as a user writes them.
const std::string kSphere = "shape = \"hypersphere\"\nradius = 0.5\n";
const std::string kCube = "shape = \"hyperbox\"\nsize = [1, 1, 1, 1]\n";
const std::string kSmooth = "friction = 0\n", kFixedRotation = "fixed = [\"rotation\"]\n";
const std::string kFixed = "fixed = [\"position\", \"rotation\"]\n";
const std::string kAbove = "position = [0, 90, 0, 0]\n";  // alone: it does not fall as far
const std::string kFloor = "[[body]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\noffset = 0\n";

std::string physics(const std::string& lines = "") { return "[physics]\n" + lines; }
std::string body(const std::string& lines) { return "[[body]]\n" + lines; }
std::string lattice(const std::string& count, double spacing, double height, double jitter,
                    const std::string& lines) {
    return fmt::format(
        "[[lattice]]\ncount = {}\nspacing = [{}, {}, {}, {}]\nposition = [0, {}, 0, 0]\n"
        "jitter = {}\n{}",
        count, spacing, spacing, spacing, spacing, height, jitter, lines);
}
/// 6^4 bodies of about 1 m between six walls, which fall together.
std::string heap(const std::string& lines, const std::string& other = "") {
    std::string text = physics() + kFloor;
    for (const char* normal : {"[1, 0, 0, 0]", "[-1, 0, 0, 0]", "[0, 0, 1, 0]", "[0, 0, -1, 0]",
                               "[0, 0, 0, 1]", "[0, 0, 0, -1]"})
        text +=
            fmt::format("[[body]]\nshape = \"hyperplane\"\nnormal = {}\noffset = -3.8\n", normal);
    return text + lattice("[6, 6, 6, 6]", 1.2, 4, 0.1, lines) + other;
}
/// 10^4 spheres that fly along.
std::string gas(const std::string& lines) {
    const std::string all = kSphere + kSmooth + "restitution = 1\n" + lines;
    return physics("gravity = [0, 0, 0, 0]\n") +
           lattice("[10, 10, 10, 10]", 2.4, 0, 0.4, all + "velocity = [1, 0, 0, 0]\n");
}
/// 5^3 towers of ten boxes.
std::string towers(const std::string& settings) {
    return physics(settings) + kFloor +
           lattice("[5, 10, 5, 5]", 1, 5, 0, "shape = \"hyperbox\"\nsize = [0.9, 1, 0.9, 0.9]\n");
}
/// A sphere that falls on its own, x metres from the others of its kind.
std::string alone_at(double x) { return kSphere + fmt::format("position = [{}, 90, 0, 0]\n", x); }
std::string view(const std::string& camera, const std::string& render = "") {
    return "[camera]\n" + camera + "[render]\nsize = [256, 256]\nsamples = 4\n" + render;
}
/// 10^4 spheres in front of the camera, all at this place along w.
std::string block(double w = 0.1) {
    return fmt::format(
        "[[lattice]]\ncount = [20, 20, 25, 1]\nspacing = [1.2, 1.2, 1.2, 1]\n"
        "position = [0, 0, 0, {:.9f}]\njitter = 0\n{}{}",
        w, kSphere, kFixed);
}
const std::string kFar = "position = [0, 0, -40, 0]\n";
const std::string kSun =
    "[[light]]\ntype = \"sun\"\ndirection = [1, -2, 1, 0]\nangle = 0\n"
    "strength = 1e-9\n[[light]]\ntype = \"sky\"\n";

std::vector<Case> all_cases() {
    using enum Part;
    const std::string thin = body("shape = \"hyperbox\"\nsize = [1, 2, 1, 1]\n" + kAbove);
    const std::string cube =
        "shape = \"hyperbox\"\nsize = [0.9, 0.9, 0.9, 0.9]\n"
        "rotation = { xy = 20, zw = 35 }\n";
    const std::string spin = "angular_velocity = { xw = 1e-9 }\n", rubs = "friction = 1e-9\n";
    const std::string smooth = kSphere + kSmooth, held = kSphere + kFixedRotation;
    const std::string fixed = physics() + lattice("[10, 10, 10, 10]", 2, 0, 0, kSphere + kFixed);
    const std::string pairs = physics() + kFloor + lattice("[10, 1, 10, 10]", 2, 0.5, 0, kSphere);
    const std::string alone = body(kSphere + kAbove), smooth_alone = smooth + kAbove;
    const std::string pair =
        body("name = \"a\"\n" + alone_at(0)) + body("name = \"b\"\n" + alone_at(2));
    const std::string joint =
        "[[joint]]\ntype = \"point\"\na = \"a\"\nb = \"b\"\nanchor = [1, 90, 0, 0]\n";
    const std::string resting = physics("duration = 0.2\ngravity = [0, 0, 0, 0]\n");
    const std::string drifting = resting + body(kSphere + "velocity = [1e-3, 0, 0, 0]\n");
    const std::string key =
        "[[camera.key]]\ntime = 0\nposition = [0, 0, -40, 0]\n"
        "[[camera.key]]\ntime = 1\nposition = [0, 0, -40, 1e-9]\n";
    const std::string far = view(kFar) + block();
    const std::string same_noise = view(kFar, "lock_noise = true\n") + block();
    return {
        {"friction", "friction", kStep, 240, heap(held + rubs), heap(held + kSmooth)},
        {"friction_and_rotors", "friction", kStep, 240, heap(kSphere + rubs), heap(smooth)},
        {"rolling_friction", "rolling friction", kStep, 240,
         heap(kSphere + "rolling_friction = 1e-9\n"), heap(kSphere)},
        {"rotors_of_all", "rotors and angular velocities", kStep, 10, gas(spin), gas("")},
        {"rotors_of_one", "rotors and angular velocities", kStep, 240,
         heap(smooth, body(smooth_alone + spin)), heap(smooth, body(smooth_alone))},
        {"inertia", "gyroscopic term and 6x6 inertia", kIslands, 240, heap(cube, thin),
         heap(cube, alone)},
        {"restitution", "restitution", kStep, 240, heap(kSphere, alone + "restitution = 1\n"),
         heap(kSphere, alone)},
        {"seams", "seams", kStep, 240, heap(kSphere, body(kCube + kFixed + kAbove)),
         heap(kSphere, body(kSphere + kFixed + kAbove))},
        {"joints", "", kStep, 240, heap(kSphere, pair + joint), heap(kSphere, pair)},
        {"colours_of_towers", "", kColours, 30, towers(""), towers("")},
        {"colours_of_heap", "", kColours, 240, heap(kSphere), heap(kSphere)},
        {"colours_of_pairs", "", kColours, 30, pairs, pairs},
        {"awake_at_rest", "", kStep, 200, towers(""), towers("sleeping = true\n")},
        {"steps", "physics", kSimulate, 0, fixed + alone, fixed},
        {"shadow_rays", "shadow rays", kFilm, 0, far + kSun, far},
        {"bodies_off_the_slice", "", kFilm, 0, view(kFar) + block(0.5 - 1e-6),
         view(kFar) + block(0.5 + 1e-6)},
        {"channels", "channel albedo", kFilm, 0, far,
         view(kFar, "channels = [\"color\"]\n") + block()},
        {"lens", "lens", kFilm, 0, view(kFar + "aperture = 1e-9\nfocus_distance = 40\n") + block(),
         view(kFar + "aperture = 0\nfocus_distance = 40\n") + block()},
        {"ghosts", "ghosts", kFilm, 0, view(kFar, "ghost_depth = 1e-9\n") + block(), far},
        {"overlay", "overlay", kFilm, 0, far + "[overlay]\ntitle = \"-\"\n", far},
        {"shutter", "motion blur", kFilm, 0, view(kFar + "shutter = 1e-9\n") + block() + drifting,
         view(kFar) + block() + drifting},
        {"frames_at_rest", "moving camera", kFilm, 0, resting + same_noise + key,
         resting + same_noise},
    };
}

fs::path own_folder() {
    return fs::temp_directory_path() / fmt::format("tesserae-leave-out-{}", getpid());
}

scenes::Scene scene_of(const std::string& text) {
    const fs::path file = own_folder() / "scene.toml";
    std::ofstream(file) << text;
    return scenes::load_scene(file, {});
}

/// Processor time of a piece of work [s].
template <class F>
double time_of(const F& work) {
    const double begin = thread_time();
    work();
    return thread_time() - begin;
}

/// Steps of a world that has settled.
Work steps_of(scenes::Scene scene, int settle) {
    auto world = std::make_shared<parallel::ParallelStepper>(
        make_simulation(std::move(scene.bodies), *scene.physics, std::move(scene.joints)));
    for (int i = 0; i < settle; ++i) world->step(kSeconds);
    return [world] {
        return time_of([&] {
            for (int i = 0; i < kSteps; ++i) world->step(kSeconds);
        });
    };
}

/// The islands of one step: built and solved.
Work islands_of(scenes::Scene scene, int settle, std::uint32_t coloured_from) {
    parallel::ParallelStepper world(std::move(scene.bodies), *scene.physics);
    for (int i = 0; i < settle; ++i) world.step(kSeconds);
    auto found = std::make_shared<StageCopy>(Stage::kBuildIslands);
    world.observe(found.get());
    world.step(kSeconds);
    auto builder = std::make_shared<IslandBuilder>(coloured_from);
    return [=] {
        const Simulation& simulation = found->simulation;
        StepData step = found->step;
        return time_of([&] {
            builder->build(simulation, step);
            integrate_velocities(simulation, step, {0, simulation.bodies.size()});
            for (std::size_t i = 0; i < step.islands.size(); ++i) {
                solve_island(simulation, step, i);
                apply_correction(simulation, step, i);
            }
        });
    };
}

/// `tesserae simulate`, or all frames of `tesserae render`.
Work program_of(const scenes::Scene& scene, bool films, const fs::path& folder) {
    const scenes::Plan plan = scenes::make_plan(scene, 1);
    const fs::path trajectory = folder / "trajectory.h5";
    const auto simulate = [=] {
        if (plan.moves)
            scenes::simulate(scene, plan, trajectory, {.overwrite = true, .quiet = true});
    };
    if (!films)
        return [=] {
            fs::remove(trajectory);
            return time_of(simulate);
        };
    simulate();
    std::vector<int> frames(static_cast<std::size_t>(plan.frames));
    std::iota(frames.begin(), frames.end(), 0);
    return [=] {
        fs::remove_all(folder / "frames");
        return time_of([&] {
            scenes::film(scene, frames, plan.moves ? trajectory : fs::path(), folder,
                         scenes::Replace::kAll, true);
        });
    };
}

Work work_of(const Case& c, bool with) {
    const fs::path folder = own_folder() / (with ? "with" : "without");
    fs::remove_all(folder);
    fs::create_directories(folder);
    const scenes::Scene scene = scene_of(with ? c.with : c.without);
    const std::vector<scenes::Decision> all = scenes::make_plan(scene, 1).decisions;
    const bool left_out = std::any_of(all.begin(), all.end(), [&](const scenes::Decision& d) {
        return d.part == c.decision && !d.needed;
    });
    if (*c.decision != 0 && left_out == with)
        throw RunError(fmt::format("{}: the plan does not {} \"{}\"", c.name,
                                   with ? "need" : "leave out", c.decision));
    if (c.part == Part::kStep) return steps_of(scene, c.settle);
    if (c.part == Part::kIslands) return islands_of(scene, c.settle, kColouredFrom);
    if (c.part == Part::kColours) return islands_of(scene, c.settle, with ? 1 : kNever);
    return program_of(scene, c.part == Part::kFilm, folder);
}

double quantile(std::vector<double> values, double part) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(
        std::lround(part * static_cast<double>(values.size() - 1)))];
}

void measure(const Case& c) {
    const Work with = work_of(c, true), without = work_of(c, false);
    std::vector<double> needed, left_out, ratio;
    for (int i = -1; i < kRepeats; ++i) {
        const double a = with(), b = without();
        if (i < 0) continue;  // sizes settle, files are there
        needed.push_back(1e3 * a), left_out.push_back(1e3 * b), ratio.push_back(a / b);
    }
    const double median = quantile(ratio, 0.5);
    fmt::print("{},{:.4g},{:.4g},{:.4g},{:.4g},{:.0f}\n", c.name, quantile(needed, 0.5),
               quantile(left_out, 0.5), quantile(needed, 0) / quantile(left_out, 0), median,
               100 * (quantile(ratio, 0.75) - quantile(ratio, 0.25)) / median);
}

}  // namespace
}  // namespace tesserae::bench

int main(int argc, char** argv) {
    using namespace tesserae::bench;
    const std::vector<std::string> names(argv + 1, argv + argc);
    int status = 0;  // 1 if the plan decides otherwise than the table says
    std::filesystem::create_directories(own_folder());
    fmt::print("part,needed_ms,left_out_ms,ratio_of_least,ratio,spread_percent\n");
    tesserae::parallel::Threads(1).run([&] {
        for (const Case& c : all_cases()) {
            if (!names.empty() && std::find(names.begin(), names.end(), c.name) == names.end())
                continue;
            try {
                measure(c);
            } catch (const std::exception& error) {
                fmt::print(stderr, "{}: {}\n", c.name, error.what());
                status = 1;
            }
        }
    });
    std::filesystem::remove_all(own_folder());
    return status;
}
