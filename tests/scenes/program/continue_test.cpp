// SPDX-License-Identifier: Apache-2.0
// A finished simulation that is wanted longer: the same command continues it.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/scenes/program/program.hpp"
#include "tests/scenes/trajectory/datasets.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

/// Spheres and boxes of small_scene() in a heap by 1 s, in which contacts carry impulses on.
std::string heap_scene() {
    return small_scene(1) + R"([[lattice]]
name = "boxes"
shape = "hyperbox"
size = [0.4, 0.3, 0.5, 0.4]
count = [2, 2, 2, 2]
spacing = [0.7, 0.7, 0.7, 0.7]
jitter = 0.05
position = [0, 3, 0, 0]
)";
}

std::vector<std::string> simulation(const std::string& scene, const std::string& file,
                                    const std::string& duration,
                                    const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"simulate", scene,   "-o",
                                      file,       "--set", "physics.duration=" + duration};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// @param each   with each number of threads, or by turns with one
void expect_bytes_of_one_straight_run(bool each) {
    const Folder folder("continue");
    const auto scene = folder.write("heap.toml", heap_scene());
    const std::vector<std::vector<std::string>> settings = {
        {},
        {"--store-every", "7", "--set", "body.floor.rolling_friction=0.02"},
        {"--set", "body.floor.rolling_friction=0.02", "--set", "physics.sleeping=true", "--set",
         "physics.substeps=3"}};
    for (const std::vector<std::string>& every : settings) {
        const auto straight = folder.file("straight.h5");
        fs::remove(straight);
        ASSERT_EQ(tesserae(simulation(scene, straight, "2.5", every)).status, 0);
        if (&every == &settings.back()) {
            // There are bodies to wake up, or to be left asleep, when the run goes on.
            EXPECT_GT(TrajectoryReader(straight).facts().back().report.asleep, 0u);
        }
        for (const char* threads : {"1", "2"}) {
            if (!each && (*threads == '1') == (&every == &settings[1])) continue;
            std::vector<std::string> more = every;
            more.insert(more.end(), {"--threads", threads, "--json"});
            const auto file = folder.file("film.h5");
            fs::remove(file);
            std::uint64_t last = 0;
            for (const char* duration : {"0", "0.9", "1.7", "2.5"}) {
                const Outcome run = tesserae(simulation(scene, file, duration, more));
                ASSERT_EQ(run.status, 0) << run.err;
                EXPECT_EQ(run.err, "");
                const auto report = nlohmann::json::parse(run.out);
                EXPECT_EQ(report["first_step"], last) << "it goes on where the last run ended";
                last = report["last_step"];
            }
            EXPECT_GE(last, 140u);
            EXPECT_EQ(different_datasets(straight, file), "") << threads << " threads";
        }
    }
}

TEST(Continue, AFinishedSimulationEndsWithTheBytesOfOneStraightRun) {
    expect_bytes_of_one_straight_run(false);
}
TEST(ContinueSlow, AFinishedSimulationEndsWithTheBytesOfOneStraightRun) {
    expect_bytes_of_one_straight_run(true);
}

void expect_kills_lose_nothing(int kills) {
    const Folder folder("continue");
    const auto scene = folder.write("heap.toml", heap_scene());
    const auto straight = folder.file("straight.h5"), file = folder.file("film.h5");
    const Outcome whole = tesserae(simulation(scene, straight, "20"));
    ASSERT_EQ(whole.status, 0);
    ASSERT_EQ(tesserae(simulation(scene, file, "1")).status, 0);
    const std::string finished = content(file);
    std::mt19937 random(2);
    int killed = 0;
    for (int i = 0; i < kills; ++i) {
        const int percent = std::uniform_int_distribution(2, 25)(random);
        const int delay = whole.milliseconds * percent / 100;
        if (tesserae(simulation(scene, file, "20"), SIGKILL, delay).status == 0) break;
        ++killed;
        // The finished file is as it was until it has its longer successor.
        if (different_datasets(straight, file) == "") break;
        ASSERT_EQ(content(file), finished);
    }
    EXPECT_GE(killed, 3);
    const Outcome last = tesserae(simulation(scene, file, "20"));
    ASSERT_EQ(last.status, 0) << last.err;
    EXPECT_EQ(different_datasets(straight, file), "");
    EXPECT_FALSE(fs::exists(file + ".partial"));
}

TEST(Continue, KillsLoseNothing) { expect_kills_lose_nothing(5); }
TEST(ContinueSlow, KillsLoseNothing) { expect_kills_lose_nothing(12); }

TEST(Continue, RefusesAnotherMotionAndLess) {
    const Folder folder("continue");
    const auto scene = folder.write("heap.toml", heap_scene());
    const auto file = folder.file("film.h5");
    ASSERT_EQ(tesserae(simulation(scene, file, "1")).status, 0);
    const std::string finished = content(file);
    const auto refused = [&](const Outcome& outcome, const char* words) {
        EXPECT_EQ(outcome.status, 2);
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
        EXPECT_EQ(content(file), finished);
        EXPECT_FALSE(fs::exists(file + ".partial") && fs::file_size(file + ".partial") > 0);
    };
    // What is wrong is named, not that the duration differs too.
    refused(tesserae(simulation(scene, file, "2", {"--set", "body.ball.radius=0.4"})),
            "\"ball\".radius: 0.5 there, 0.4 here");
    refused(tesserae(simulation(scene, file, "2", {"--store-every", "3"})), "--overwrite");
    refused(tesserae(simulation(scene, file, "0.5")), "physics.duration: 1 there, 0.5 here");
    // Nothing is missing: the file stays as it is, whatever the picture.
    const Outcome same =
        tesserae(simulation(scene, file, "1", {"--set", "camera.field_of_view=20"}));
    EXPECT_EQ(same.status, 0) << same.err;
    EXPECT_EQ(content(file), finished);
    const Outcome shorter = tesserae(simulation(scene, file, "0.5", {"--overwrite"}));
    EXPECT_EQ(shorter.status, 0) << shorter.err;
    EXPECT_LT(fs::file_size(file), finished.size());
}

TEST(Continue, RenderTakesALongerTrajectoryThanTheSceneNeeds) {
    const Folder folder("continue");
    const auto scene = folder.write("heap.toml", small_scene(0.2));
    const auto render = [&](const char* duration, const char* out) {
        const std::string file = folder.file(std::string(out) + ".h5");
        EXPECT_EQ(tesserae(simulation(scene, file, duration)).status, 0);
        return tesserae({"render", scene, "--trajectory", file, "-o", folder.file(out)});
    };
    EXPECT_EQ(render("0.2", "own").status, 0);
    EXPECT_EQ(render("1", "longer").status, 0);
    const auto frames = files_below(folder / "own");
    EXPECT_GE(frames.size(), 8u);
    EXPECT_EQ(files_below(folder / "longer"), frames);
    for (const std::string& name : frames)
        EXPECT_EQ(content(folder / "own" / name), content(folder / "longer" / name)) << name;
    const Outcome shorter = render("0.1", "shorter");
    EXPECT_EQ(shorter.status, 2);
    EXPECT_NE(shorter.err.find("is not stored"), std::string::npos) << shorter.err;
}

}  // namespace
}  // namespace tesserae::scenes::testing
