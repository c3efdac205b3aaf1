// SPDX-License-Identifier: Apache-2.0
// Signals and kills at any moment lose nothing: the same command ends with the same bytes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>
#include <random>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

/// Everything that must not depend on interruptions: all but the report, which holds times.
void expect_same_results(const Folder& folder, const char* straight, const char* interrupted) {
    for (const std::string& file : files_below(folder / straight)) {
        if (file == "report.json") continue;
        // An HDF5 file's free space may differ; its datasets are compared by the trajectory tests.
        if (file == "trajectory.h5") continue;
        EXPECT_EQ(content(folder / straight / file), content(folder / interrupted / file)) << file;
    }
    EXPECT_EQ(files_below(folder / straight), files_below(folder / interrupted));
}

TEST(Interrupt, SignalsGiveTheirStatusAndTheSameCommandFinishes) {
    const Folder folder("signals");
    const auto scene = folder.write("drop.toml", small_scene(2));
    const auto command = [&](const char* out) {
        return std::vector<std::string>{"run",    scene,   "-o",        folder.file(out),
                                        "--size", "96x72", "--threads", "2"};
    };
    const Outcome straight = tesserae(command("straight"));
    ASSERT_EQ(straight.status, 0);
    int stopped = 0;
    for (const int percent : {0, 10, 20, 20, 30}) {
        const int signal = percent % 20 == 0 ? SIGINT : SIGTERM;
        const int delay = 1 + straight.milliseconds * percent / 100;
        const Outcome outcome = tesserae(command("out"), signal, delay);
        // Done already, or ended by the system before main began.
        if (outcome.status == 0 || outcome.status == 1000 + signal) continue;
        EXPECT_EQ(outcome.status, 128 + signal) << outcome.err;
        ++stopped;
        // Every frame that has its name can be read.
        std::vector<std::string> words = {"hash"};
        for (const std::string& file : files_below(folder / "out"))
            if (file.ends_with(".exr")) words.push_back(folder.file("out/" + file));
        if (words.size() == 1) continue;
        const Outcome hash = tesserae(words);
        EXPECT_EQ(hash.status, 0) << hash.err;
    }
    EXPECT_GE(stopped, 2);
    const Outcome last = tesserae(command("out"));
    ASSERT_EQ(last.status, 0) << last.err;
    expect_same_results(folder, "straight", "out");
}

TEST(Interrupt, KillsLoseNothing) {
    const Folder folder("kills");
    const auto scene = folder.write("drop.toml", small_scene(1));
    const auto command = [&](const char* out) {
        return std::vector<std::string>{"run", scene, "-o", folder.file(out), "--size", "96x72"};
    };
    const Outcome straight = tesserae(command("straight"));
    ASSERT_EQ(straight.status, 0);
    std::mt19937 random(1);
    int killed = 0;
    for (int i = 0; i < 5; ++i) {
        const int percent = std::uniform_int_distribution(5, 50)(random);
        const int delay = straight.milliseconds * percent / 100;
        killed += tesserae(command("out"), SIGKILL, delay).status == 1000 + SIGKILL;
    }
    EXPECT_GE(killed, 2);
    const Outcome last = tesserae(command("out"));
    ASSERT_EQ(last.status, 0) << last.err;
    expect_same_results(folder, "straight", "out");
}

/// A heap of boxes into which one flies at 100 km/s: all become fast, and a step takes long.
std::string slow_scene(int count, double duration) {
    return fmt::format(R"(
physics = {{ duration = {} }}
render = {{ frames_per_second = 240 }}
camera = {{ position = [0, 2, -20, 0] }}
light = [{{ type = "sky" }}]
body = [
  {{ name = "bullet", shape = "hyperbox", size = [0.3, 0.3, 0.3, 0.3], position = [-3, 0, 0, 0], velocity = [1e5, 0, 0, 0] }},
]
lattice = [
  {{ name = "heap", shape = "hyperbox", size = [0.3, 0.3, 0.3, 0.3], count = [{}, 10, 10, 10], spacing = 0.31, jitter = 0.01 }},
]
)",
                       duration, count);
}

TEST(Interrupt, AStepThatTakesLongEndsAtOnce) {
    const Folder folder("slow_step");
    const std::string scene = folder.write("hit.toml", slow_scene(10, 1));
    for (const int signal : {SIGTERM, SIGINT}) {
        const Outcome outcome =
            tesserae({"simulate", scene, "-o", folder.file("hit.h5"), "--quiet"}, signal, 1000);
        EXPECT_EQ(outcome.status, 128 + signal);
        EXPECT_NE(outcome.err.find("stopped by signal"), std::string::npos) << outcome.err;
    }
}

TEST(InterruptSlow, WhatStopsAmidAStepGoesOnWithTheSameBytes) {
    const Folder folder("slow_steps");
    const std::string scene = folder.write("hit.toml", slow_scene(3, 0.0167));
    const auto simulate = [&](const char* file, int signal = 0, int delay = 0) {
        return tesserae({"simulate", scene, "-o", folder.file(file)}, signal, delay);
    };
    const Outcome straight = simulate("straight.h5");
    ASSERT_EQ(straight.status, 0) << straight.err;
    EXPECT_NE(straight.err.find("warning: a step took"), std::string::npos) << straight.err;
    int stopped = 0;
    for (int delay = 300; delay < 2000; delay += 400)
        stopped += simulate("parts.h5", SIGTERM, delay).status == 143;
    EXPECT_GE(stopped, 2);
    ASSERT_EQ(simulate("parts.h5").status, 0);
    const auto hash = [&](const char* file) {
        const std::string out = tesserae({"hash", folder.file(file)}).out;
        return out.substr(0, out.find_first_of(" \n"));
    };
    EXPECT_EQ(hash("parts.h5"), hash("straight.h5"));
}

}  // namespace
}  // namespace tesserae::scenes::testing
