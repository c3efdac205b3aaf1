// SPDX-License-Identifier: Apache-2.0
#include "scenes/plan/cost.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "parallel/threads.hpp"
#include "scenes/film/film.hpp"
#include "scenes/film/simulate.hpp"
#include "scenes/plan/rehearsal.hpp"
#include "scenes/timeline.hpp"
#include "scenes/trajectory/trajectory.hpp"
#include "tests/scenes/load/load_scene_text.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// Balls that fall on each other, before a camera.
std::string falling(int steps) {
    return "[physics]\nsteps_per_second = 60\nduration = " + std::to_string(steps / 60.0) + R"(
[render]
size = [96, 64]
samples = 2
frames_per_second = 20
[[body]]
shape = "hyperplane"
normal = [0, 1, 0, 0]
offset = -1
[[lattice]]
shape = "hypersphere"
radius = 0.3
count = [3, 2, 2, 2]
spacing = [0.7, 0.7, 0.7, 0.7]
jitter = 0.05
)";
}

TEST(Rehearsal, TakesTheStepsOfTheSimulation) {
    const Scene scene = load_text(falling(60), {});
    const Plan plan = make_plan(scene, 2);
    const tesserae::testing::TemporaryFolder folder("rehearsal");
    Rehearsal rehearsal;
    parallel::Threads(2).run([&] {
        simulate(scene, plan, folder / "a.h5", {.store_every = 1, .quiet = true});
        rehearsal = rehearse(scene, plan, plan.steps, 1e9);
    });
    EXPECT_TRUE(rehearsal.is_whole());
    EXPECT_EQ(rehearsal.steps, 60u);
    EXPECT_GT(rehearsal.seconds, 0);
    ASSERT_GE(rehearsal.poses.size(), 4u);
    const TrajectoryReader trajectory(folder / "a.h5");
    Bodies there = scene.bodies;
    const double gap = rehearsal.poses[1].time;
    for (std::size_t i = 0; i < rehearsal.poses.size(); ++i) {
        const TimedBodies& at = rehearsal.poses[i];
        EXPECT_NEAR(at.time, static_cast<double>(i) * gap, 1e-12) << "evenly spread";
        trajectory.read_row(static_cast<std::uint64_t>(std::lround(at.time * 60)), there);
        EXPECT_EQ(at.bodies.position, there.position);
    }
    EXPECT_GT(rehearsal.poses.back().time, 0.5);
}

TEST(Rehearsal, GuessesWhatItHadNoTimeFor) {
    const Scene scene = load_text(falling(600'000), {});
    Rehearsal rehearsal;
    parallel::Threads(1).run(
        [&] { rehearsal = rehearse(scene, make_plan(scene, 1), 600'000, 0.05); });
    EXPECT_FALSE(rehearsal.is_whole());
    EXPECT_GE(rehearsal.taken, 1u);
    // What is left costs at least as much a step as the cheapest that were taken.
    EXPECT_GT(rehearsal.seconds, 100 * 0.05);
    EXPECT_NEAR(rehearsal.contacts, 2.3 * 24, 1e-9) << "24 balls come to rest";
}

/// A clock that has run ahead, or a machine so slow that the time is over at once.
TEST(Rehearsal, TakesOneStepAtLeast) {
    const Scene scene = load_text(falling(600'000), {});
    for (const double seconds : {0.0, -1e9}) {
        Rehearsal rehearsal;
        Cost cost;
        parallel::Threads(1).run([&] {
            rehearsal = rehearse(scene, make_plan(scene, 1), 600'000, seconds);
            cost = measure_cost(scene, make_plan(scene, 1), {}, {0, 1, 2}, seconds);
        });
        EXPECT_EQ(rehearsal.taken, 1u);
        EXPECT_GT(rehearsal.seconds, 0);
        EXPECT_GT(cost.render_seconds, 0);
        EXPECT_TRUE(cost.is_rough());
    }
}

/// Samples beyond some tens are not taken: one tile of this frame would take minutes.
TEST(Cost, OfVeryManySamplesIsToldAfterSome) {
    const auto cost_of = [](const char* samples) {
        const Scene scene = load_text(
            "[render]\nintegrator = \"path\"\nsize = [64, 32]\nsamples = " + std::string(samples) +
                "\n[[light]]\ntype = \"sky\"\n[[body]]\nshape = \"hypersphere\"\nradius = 1\n",
            {});
        Cost cost;
        parallel::Threads(1).run(
            [&] { cost = measure_cost(scene, make_plan(scene, 1), {}, {0}, 0); });
        return cost.render_seconds;
    };
    EXPECT_GT(cost_of("1048576"), 100 * cost_of("16"));
}

TEST(Cost, IsThatOfTheFilm) {
    const Scene scene = load_text(falling(60), {});
    const Plan plan = make_plan(scene, 2);
    const std::vector<int> frames = parse_frames("", plan.frames);
    const tesserae::testing::TemporaryFolder folder("cost");
    Cost cost, known;
    parallel::Threads(2).run([&] {
        cost = measure_cost(scene, plan, {}, frames, 1e9);
        simulate(scene, plan, folder / "a.h5", {.quiet = true});
        known = measure_cost(scene, plan, folder / "a.h5", frames, 1e9);
        film(scene, frames, folder / "a.h5", folder.path() / "film", Replace::kNothing, true);
    });
    EXPECT_TRUE(cost.guessed.empty());
    EXPECT_GT(cost.simulate_seconds, 0);
    EXPECT_GT(cost.render_seconds, 0);
    EXPECT_EQ(known.simulate_seconds, 0) << "it is there";
    EXPECT_EQ(cost.measured.front(), "57 of 57 steps") << "to the last of 20 frames";
    double bytes = 0;
    for (const auto& entry : fs::directory_iterator(folder.path() / "film/frames"))
        bytes += static_cast<double>(entry.file_size());
    // All tiles of some frames, without the header.
    EXPECT_NEAR(static_cast<double>(cost.frame_bytes) / bytes, 1, 0.2);
    EXPECT_NEAR(static_cast<double>(known.frame_bytes) / bytes, 1, 0.2);
}

TEST(Cost, OfAStillIsThatOfItsFrame) {
    const Scene scene = load_text("[render]\nsize = [64, 32]\nsamples = 1\n", {});
    Cost cost;
    parallel::Threads(1).run([&] { cost = measure_cost(scene, make_plan(scene, 1), {}, {0}, 1); });
    EXPECT_EQ(cost.simulate_seconds, 0);
    EXPECT_GT(cost.render_seconds, 0);
    EXPECT_EQ(cost.measured, std::vector<std::string>{"2 of 2 tiles of 1 frames"});
}

}  // namespace
}  // namespace tesserae::scenes
