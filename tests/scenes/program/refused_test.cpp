// SPDX-License-Identifier: Apache-2.0
// What is refused is told with its path and leaves nothing behind.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// A scene that moves, its trajectory, a text that is neither, and a loop of links.
class Refused : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_EQ(tesserae({"simulate", scene_, "-o", trajectory_}).status, 0);
        fs::create_symlink("loop-b", folder_.file("loop-a"));
        fs::create_symlink("loop-a", folder_.file("loop-b"));
    }
    /// Runs it and checks that the folder is as before.
    void expect_refused(const Words& words, int status, const std::string& said) const {
        std::string all;
        for (const std::string& word : words) all += word + " ";
        const auto before = files_below(folder_.path());
        const Outcome outcome = tesserae(words);
        EXPECT_EQ(outcome.status, status) << all << outcome.err;
        EXPECT_NE(outcome.err.find(said), std::string::npos) << all << outcome.err;
        EXPECT_EQ(files_below(folder_.path()), before) << all;
    }

    const Folder folder_{"refused"};
    const std::string scene_ = folder_.write("drop.toml", small_scene(0.1)),
                      text_ = folder_.write("text.txt", "some text"),
                      plain_ = folder_.write("plain", "no folder"),
                      trajectory_ = folder_.file("drop.h5"), loop_ = folder_.file("loop-a");
};

TEST_F(Refused, AnOutputLeavesNothing) {
    const std::string none = folder_.file("none");
    expect_refused({"simulate", scene_, "-o", trajectory_, "--set", "physics.gravity=[0,-9,0,0]"},
                   2, "drop.h5");
    expect_refused({"simulate", scene_, "-o", text_}, 2, "text.txt");
    expect_refused({"simulate", scene_, "-o", text_ + "/a.h5"}, 1, "text.txt/a.h5");
    expect_refused({"view", scene_, "-o", trajectory_}, 2, "drop.h5");
    expect_refused({"view", scene_, "-o", text_ + "/a.html"}, 1, "text.txt/a.html");
    expect_refused({"plot", trajectory_, "-o", trajectory_}, 2, "drop.h5");
    expect_refused({"plot", trajectory_, "-o", none + "/a.svg"}, 1, "none/a.svg");
    expect_refused({"export", trajectory_, "--format", "ply", "-o", plain_}, 1, "plain");
    expect_refused({"run", scene_, "-o", plain_, "--quiet"}, 1, "plain");
    expect_refused({"render", scene_, "-o", plain_}, 1, "plain");
    expect_refused({"submit", scene_, "-o", plain_}, 1, "plain");
}

TEST_F(Refused, ALoopOfLinksIsTold) {
    const std::string reason = "loop-a";
    for (const char* command : {"info", "hash", "film", "status", "join"})
        expect_refused({command, loop_}, 2, reason);
    for (const char* command : {"run", "submit", "render"})
        expect_refused({command, loop_, "-o", folder_.file("out")}, 2, reason);
    expect_refused({"plot", loop_, "-o", folder_.file("a.svg")}, 2, reason);
    expect_refused({"simulate", scene_, "-o", loop_}, 1, reason);
    for (const char* command : {"run", "submit", "render"})
        expect_refused({command, scene_, "-o", loop_}, 1, reason);
    for (const std::string& said : {tesserae({"film", loop_}).err, tesserae({"join", loop_}).err})
        EXPECT_EQ(said.find("filesystem error"), std::string::npos) << said;
}

TEST_F(Refused, AnOutputIsNotNamedAsSomethingElse) {
    for (const char* name : {"a.csv", "a.toml", "a.mp4", "a.png", "a.exr", "a.html"})
        expect_refused({"simulate", scene_, "-o", folder_.file(name)}, 2, "trajectory, FILE.h5");
    for (const char* name : {"a.mp4", "a.h5", "a.png"}) {
        for (const char* command : {"run", "render", "submit"})
            expect_refused({command, scene_, "-o", folder_.file(name)}, 2, "expected a folder");
        expect_refused({"export", trajectory_, "--format", "ply", "-o", folder_.file(name)}, 2,
                       "expected a folder");
    }
    expect_refused({"plot", trajectory_, "-o", folder_.file("a.csv")}, 2, ".svg or .png");
}

TEST_F(Refused, AMisspeltOptionGetsWhatWasMeant) {
    const std::string out = folder_.file("out");
    expect_refused({"run", scene_, "-o", out, "--sampels", "3"}, 2, "did you mean \"--samples\"?");
    expect_refused({"run", scene_, "-o", out, "--sampels=3"}, 2, "did you mean \"--samples\"?");
    expect_refused({"run", scene_, "--out", out}, 2, "did you mean \"--output\"?");
    expect_refused({"simulate", scene_, "-o", trajectory_, "--thread", "2"}, 2, "\"--threads\"");
    expect_refused({"help"}, 2, "tesserae --help");
    expect_refused({"render", scene_, "-o", out, "--frames", ""}, 2, "expected frames");
    expect_refused({"run", scene_, "-o", out, "--frames="}, 2, "--frames");
}

/// What no command could do is refused by all of them.
TEST_F(Refused, ASceneIsRefusedByEveryCommand) {
    const std::pair<const char*, const char*> scenes[] = {
        {"[physics]\nduration = 1e15\n", "2^53 steps"},
        {"[physics]\nduration = 1e9\n[render]\nframes_per_second = 1\n", "frames: expected fewer"}};
    for (const auto& [text, said] : scenes) {
        const auto endless = folder_.write("endless.toml", text);
        for (const char* command : {"info", "hash", "plan"})
            expect_refused({command, endless}, 2, said);
    }
}

TEST_F(Refused, TheEndOfALineIsNoPartOfAJobScript) {
    const std::string out = folder_.file("out");
    for (const char* option : {"--sbatch", "--account", "--partition"})
        for (const char* value : {"a\ntouch b", "a\rb", "a\tb"})
            expect_refused({"submit", scene_, "-o", out, std::string(option) + "=" + value}, 2,
                           option);
    expect_refused({"submit", scene_, "-o", out + "\nb"}, 2, "-o");
}

/// A drawing program that dies, or a disk without room.
TEST_F(Refused, APlotSaysWhyItFailed) {
    const std::string bin = folder_.file("bin");
    fs::create_directory(bin);
    const auto with_gnuplot = [&](const std::string& script) {
        std::ofstream(bin + "/gnuplot") << "#!/bin/sh\n" << script << "\n";
        fs::permissions(bin + "/gnuplot", fs::perms::owner_all);
        const std::string path = std::getenv("PATH");
        ::setenv("PATH", (bin + ":" + path).c_str(), 1);
        const Outcome plot = tesserae({"plot", trajectory_, "-o", folder_.file("a.svg")});
        ::setenv("PATH", path.c_str(), 1);
        EXPECT_EQ(plot.status, 1);
        EXPECT_NE(plot.err.find("a.svg"), std::string::npos) << plot.err;
        EXPECT_FALSE(fs::exists(folder_.file("a.svg")));
        return plot.err;
    };
    EXPECT_NE(with_gnuplot("kill -9 $$").find("signal 9"), std::string::npos);
    EXPECT_NE(with_gnuplot("echo no font >&2; exit 3").find("no font"), std::string::npos);
    EXPECT_NE(with_gnuplot("exit 0").find("drew nothing"), std::string::npos);
}

}  // namespace
}  // namespace tesserae::scenes::testing
