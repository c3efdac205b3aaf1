// SPDX-License-Identifier: Apache-2.0
// `tesserae hash` and `tesserae diff` as a user meets them: lines, exit statuses, threads.
#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

/// Two films of one motion, the second with more samples.
class CompareProgram : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<Folder>("compare");
        folder_->write("drop.toml", small_scene(0.15));
        for (const char* out : {"a", "b"})
            ASSERT_EQ(run({"run", file("drop.toml"), "-o", file(out), "--samples",
                           *out == 'a' ? "1" : "2"})
                          .status,
                      0);
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static Outcome run(const std::vector<std::string>& words) { return tesserae(words); }
    static std::string file(const std::string& name) { return folder_->file(name); }
    /// The first 32 digits of hash's output.
    static std::string hash(const std::string& name) {
        return run({"hash", file(name)}).out.substr(0, 32);
    }

    static inline std::unique_ptr<Folder> folder_;
};

TEST_F(CompareProgram, HashPrintsALineForEachFile) {
    const std::string scene = file("drop.toml"), film = file("a"),
                      trajectory = file("b/trajectory.h5"), frame = file("a/frames/drop.0001.exr");
    const Outcome hashes = run({"hash", scene, film, trajectory, frame});
    ASSERT_EQ(hashes.status, 0) << hashes.err;
    const Outcome info = run({"info", scene, "--json"});
    const auto facts = nlohmann::json::parse(info.out);
    EXPECT_EQ(hashes.out, facts["hash"].get<std::string>() + "  " + scene + "\n" +
                              facts["motion hash"].get<std::string>() + "  " + scene +
                              " (motion)\n" + hash("a") + "  " + film + "\n" +
                              hash("b/trajectory.h5") + "  " + trajectory + "\n" +
                              hash("a/frames/drop.0001.exr") + "  " + frame + "\n");
    for (const char* name : {"a", "b/trajectory.h5", "a/frames/drop.0001.exr"})
        EXPECT_EQ(hash(name).find_first_not_of("0123456789abcdef"), std::string::npos);

    const auto json = nlohmann::json::parse(
        run({"hash", scene, film, trajectory, frame, "--json"}).out)["hashes"];
    ASSERT_EQ(json.size(), 4u);
    EXPECT_EQ(json[0]["kind"], "scene");
    EXPECT_EQ(json[0]["motion_hash"], facts["motion hash"]);
    EXPECT_EQ(json[1]["kind"], "frames");
    EXPECT_EQ(json[1]["frames"]["drop.0001.exr"], json[3]["hash"]);
    EXPECT_EQ(json[1]["frames"].size(), 3u);
    EXPECT_EQ(json[2]["kind"], "trajectory");
    EXPECT_EQ(json[2]["hash"], hash("b/trajectory.h5"));
    EXPECT_EQ(json[3]["file"], frame);
}

TEST_F(CompareProgram, HashIsTheSameAtAnyThreadCountAndAfterAnInterruption) {
    const std::string by_default = run({"hash", file("a")}).out;
    for (const char* threads : {"1", "2", "4"})
        EXPECT_EQ(run({"hash", file("a"), "--threads", threads}).out, by_default);
    const std::string scene = folder_->write("long.toml", small_scene(5));
    const std::vector<std::string> words = {"simulate", scene, "--store-every", "1", "-o"};
    const auto simulate = [&](const char* name, int signal = 0, int delay = 0) {
        std::vector<std::string> line = words;
        line.push_back(file(name));
        return tesserae(line, signal, delay);
    };
    const Outcome straight = simulate("straight.h5");
    ASSERT_EQ(straight.status, 0);
    EXPECT_NE(simulate("stopped.h5", SIGINT, straight.milliseconds / 3).status, 0);
    ASSERT_EQ(simulate("stopped.h5").status, 0);
    EXPECT_EQ(hash("straight.h5"), hash("stopped.h5"));
    EXPECT_EQ(run({"diff", file("straight.h5"), file("stopped.h5")}).out, "equal\n");
}

TEST_F(CompareProgram, HashStopsAtTheFirstThatCannotBeRead) {
    fs::create_directories(file("empty"));
    for (const char* bad : {"missing.h5", "empty"}) {
        const Outcome hashes = run({"hash", file("a"), file(bad), file("b")});
        EXPECT_EQ(hashes.status, 2);
        EXPECT_EQ(hashes.out, hash("a") + "  " + file("a") + "\n");
        EXPECT_NE(hashes.err.find(file(bad)), std::string::npos) << hashes.err;
    }
    EXPECT_EQ(run({"hash"}).status, 2);
}

TEST_F(CompareProgram, DiffsExitStatusSaysWhetherTheyDiffer) {
    const Outcome same = run({"diff", file("a"), file("a")});
    EXPECT_EQ(same.status, 0);
    EXPECT_EQ(same.out, "equal\n");
    for (const char* name : {"", "/trajectory.h5", "/frames/drop.0002.exr", "/scene.toml"}) {
        const std::vector<std::string> words = {"diff", file("a") + name, file("b") + name};
        const Outcome differ = run(words);
        EXPECT_EQ(differ.status, 1) << name;
        EXPECT_EQ(differ.out.find("different\n"), 0u) << differ.out;
        EXPECT_EQ(differ.err, "");
        std::vector<std::string> as_json = words;
        as_json.push_back("--json");
        const Outcome json = run(as_json);
        EXPECT_EQ(json.status, 1);
        EXPECT_EQ(nlohmann::json::parse(json.out)["equal"], false);
    }
    // The trajectories' effective texts differ, their rows do not.
    const Outcome trajectories = run({"diff", file("a/trajectory.h5"), file("b/trajectory.h5")});
    EXPECT_NE(trajectories.out.find("other values     /parameters/scene/effective\n"),
              std::string::npos);
    EXPECT_NE(trajectories.out.find("render.samples: 1 there, 2 here"), std::string::npos)
        << trajectories.out;
    EXPECT_NE(trajectories.out.find("motion part      equal"), std::string::npos);
    EXPECT_EQ(trajectories.out.find("first difference"), std::string::npos) << trajectories.out;
    const Outcome scenes = run({"diff", file("a/scene.toml"), file("b/scene.toml")});
    EXPECT_NE(scenes.out.find("render.samples: 1 there, 2 here"), std::string::npos) << scenes.out;

    const Outcome mixed = run({"diff", file("a"), file("a/trajectory.h5")});
    EXPECT_EQ(mixed.status, 2);
    EXPECT_NE(mixed.err.find("of one kind"), std::string::npos) << mixed.err;
    EXPECT_EQ(run({"diff", file("a"), file("missing")}).status, 2);
    EXPECT_EQ(run({"diff", file("a")}).status, 2);
    EXPECT_EQ(run({"diff", file("a"), file("a"), file("a")}).status, 2);
}

TEST_F(CompareProgram, DiffNamesBodyAndPixel) {
    ASSERT_EQ(run({"simulate", file("drop.toml"), "-o", file("faster.h5"), "--set",
                   "body.ball.velocity=[0,-1.5,0,0]"})
                  .status,
              0);
    const Outcome moved = run({"diff", file("a/trajectory.h5"), file("faster.h5"), "--json"});
    EXPECT_EQ(moved.status, 1);
    const auto trajectory = nlohmann::json::parse(moved.out)["trajectory"];
    EXPECT_EQ(trajectory["first"]["step"], 0);
    EXPECT_EQ(trajectory["first"]["name"], "ball");
    EXPECT_EQ(trajectory["first"]["component"], "velocity.y");
    EXPECT_EQ(trajectory["first"]["a"], "-1");
    EXPECT_EQ(trajectory["first"]["b"], "-1.5");
    EXPECT_EQ(trajectory["growth"].size(), 3u);
    EXPECT_EQ(trajectory["growth"][0]["velocity"], 0.5);
    EXPECT_NE(trajectory["motion"].get<std::string>().find("velocity"), std::string::npos);
    const auto frames = nlohmann::json::parse(run({"diff", file("a"), file("b"), "--json"}).out);
    EXPECT_EQ(frames["frame"], "drop.0000.exr");
    EXPECT_TRUE(frames["image"]["first"].contains("channel"));
}

}  // namespace
}  // namespace tesserae::scenes::testing
