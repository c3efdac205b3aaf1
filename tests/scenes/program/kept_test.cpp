// A film folder and an unfinished trajectory that the program made before its files told their
// versions and their bodies: they stay as useful as they were. tests/scenes/kept/kept.toml tells
// the commands that made them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/dynamics/motion_version.hpp"
#include "render/picture_version.hpp"
#include "tests/scenes/program/program.hpp"
#include "tests/scenes/trajectory/datasets.hpp"

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

/// What is kept is of the first versions; the motion is that of optimized builds for the default
/// architecture (golden_test.cpp).
class KeptMotion : public Kept {
    void SetUp() override {
        if (kMotionVersion != 1) GTEST_SKIP() << "the kept trajectories are of motion version 1";
#if !defined(__AVX2__) || !defined(__OPTIMIZE__)
        GTEST_SKIP() << "not an optimized build for x86-64-v3";
#endif
        Kept::SetUp();
    }
};

/// The datasets that differ, beside those that the older file has not.
std::string different_from_straight(const fs::path& older, const fs::path& straight) {
    const auto there = datasets_of(older);
    auto here = datasets_of(straight);
    for (const char* name : {"mass", "name", "shape", "size"}) {
        const std::string path = std::string("particles/bodies/") + name;
        EXPECT_FALSE(there.contains(path)) << path;
        EXPECT_EQ(here.erase(path), 1u) << path;
    }
    std::string names;
    for (const auto& [name, bytes] : here)
        if (!there.contains(name) || there.at(name) != bytes) names += name + " ";
    EXPECT_EQ(here.size(), there.size());
    return names;
}

TEST_F(Kept, TheSameRunFindsEverythingComplete) {
    if (kMotionVersion != 1 || render::kPictureVersion != 1)
        GTEST_SKIP() << "the kept folder is of the first versions";
    const auto run = result_of({"run", scene_, "-o", film_});
    EXPECT_EQ(run["render"]["rendered"], 0);
    EXPECT_EQ(run["render"]["copied"], 0);
    EXPECT_EQ(run["render"]["kept"], 4);
    EXPECT_EQ(run["simulate"]["first_step"], run["simulate"]["last_step"]);
    const fs::path kept = TESSERAE_SOURCE_DIR "/tests/scenes/kept/film";
    EXPECT_EQ(files_below(film_), files_below(kept));
    for (const std::string& file : files_below(kept)) {
        if (file == "report.json") continue;  // of the last run
        EXPECT_EQ(content(fs::path(film_) / file), content(kept / file)) << file;
    }
}

TEST_F(KeptMotion, AFinishedTrajectoryIsContinued) {
    const std::string straight = folder_.file("straight.h5"), file = film_ + "/trajectory.h5";
    const auto simulate = [&](const std::string& to) {
        return result_of({"simulate", scene_, "-o", to, "--set", "physics.duration=1.5"});
    };
    simulate(straight);
    const auto run = simulate(file);
    EXPECT_EQ(run["first_step"], 41);
    EXPECT_GT(run["last_step"], 300);
    EXPECT_EQ(different_from_straight(file, straight), "");
}

TEST_F(KeptMotion, AnUnfinishedTrajectoryIsContinued) {
    const std::string straight = folder_.file("straight.h5");
    const auto simulate = [&](const std::string& to) {
        return result_of(
            {"simulate", scene_, "-o", to, "--set", "physics.duration=60", "--store-every", "600"});
    };
    simulate(straight);
    EXPECT_EQ(simulate(stopped_)["first_step"], 6000);
    EXPECT_EQ(different_from_straight(stopped_, straight), "");
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
}

}  // namespace
}  // namespace tesserae::scenes::testing
