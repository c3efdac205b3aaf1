// SPDX-License-Identifier: Apache-2.0
// A film folder and an unfinished trajectory that the program made before its files told their
// versions and their bodies: they stay as useful as they were. tests/scenes/kept/kept.toml tells
// the commands that made them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

class Kept : public ::testing::Test {
  protected:
    void SetUp() override {
        const fs::path kept = TESSERAE_SOURCE_DIR "/tests/scenes/kept";
        fs::copy(kept, folder_.path(), fs::copy_options::recursive);
        fs::copy_file(kept / "stopped.unfinished", stopped_ + ".partial");
    }

    /// Runs a command that succeeds. @return its JSON
    static nlohmann::json result_of(std::vector<std::string> words) {
        words.push_back("--json");
        const Outcome outcome = tesserae(words);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        return nlohmann::json::parse(outcome.out);
    }

    const Folder folder_{"kept"};
    const std::string scene_ = folder_.file("kept.toml"), film_ = folder_.file("film"),
                      stopped_ = folder_.file("stopped.h5");
};

TEST_F(Kept, MotionOfTheSolverThatWasRemovedIsNotContinued) {
    const std::string file = film_ + "/trajectory.h5", before = content(file);
    for (const std::string& to : {file, stopped_}) {
        const Outcome outcome =
            tesserae({"simulate", scene_, "-o", to, "--set", "physics.duration=60"});
        EXPECT_EQ(outcome.status, 2);
        EXPECT_NE(outcome.err.find("solver = \"soft\" there"), std::string::npos) << outcome.err;
    }
    EXPECT_EQ(content(file), before);
}

TEST_F(Kept, TrajectoriesAndFramesAreRead) {
    const auto again = folder_.file("again");
    const auto render =
        result_of({"render", scene_, "--trajectory", film_ + "/trajectory.h5", "-o", again});
    EXPECT_EQ(render["render"]["rendered"], 4);
    const auto trajectory = result_of({"info", film_ + "/trajectory.h5"});
    EXPECT_EQ(trajectory["motion version"], 1);
    EXPECT_EQ(trajectory["rows"], 12);
    EXPECT_EQ(result_of({"info", stopped_ + ".partial"})["rows"], 11);
    const auto frame = result_of({"info", film_ + "/frames/kept.0002.exr"});
    EXPECT_EQ(frame["motion version"], 1);
    EXPECT_EQ(frame["picture version"], 1);
    EXPECT_FALSE(frame.contains("tesserae/motionVersion"));
    EXPECT_EQ(result_of({"info", again + "/frames/kept.0002.exr"})["tesserae/motionVersion"], 1);
    EXPECT_EQ(result_of({"info", scene_})["bodies"], 14);
    // Its bodies were moved by a solver that the program no longer has.
    const std::string made = film_ + "/trajectory.h5", page = folder_.file("page.html");
    EXPECT_GT(result_of({"export", made, "--format", "ply", "-o", again + "-ply"})["written"], 0);
    EXPECT_EQ(result_of({"view", made, "-o", page})["scene"], "kept");
}

}  // namespace
}  // namespace tesserae::scenes::testing
