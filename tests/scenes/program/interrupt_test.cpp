// SPDX-License-Identifier: Apache-2.0
// Signals and kills at any moment lose nothing: the same command ends with the same bytes.
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
        // Slow enough on any machine to be stopped twice.
        return std::vector<std::string>{"run",    scene,   "-o",        folder.file(out),
                                        "--size", "96x72", "--threads", "2"};
    };
    ASSERT_EQ(tesserae(command("straight")).status, 0);
    int stopped = 0;
    for (int delay : {1, 30, 60, 100, 150}) {
        const int signal = delay % 20 == 0 ? SIGINT : SIGTERM;
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
    ASSERT_EQ(tesserae(command("straight")).status, 0);
    std::mt19937 random(1);
    for (int i = 0; i < 5; ++i)
        tesserae(command("out"), SIGKILL, std::uniform_int_distribution(5, 200)(random));
    const Outcome last = tesserae(command("out"));
    ASSERT_EQ(last.status, 0) << last.err;
    expect_same_results(folder, "straight", "out");
}

}  // namespace
}  // namespace tesserae::scenes::testing
