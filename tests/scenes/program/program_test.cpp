// SPDX-License-Identifier: Apache-2.0
// The program as a user meets it: exit statuses, messages, files.
#include "tests/scenes/program/program.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <nlohmann/json.hpp>

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

TEST(Program, RunMakesTrajectoryFramesPreviewsAndReport) {
    const WithFilms films;
    const Folder folder("run");
    const auto scene = folder.write("drop.toml", small_scene(0.15));
    const Outcome run = tesserae({"run", scene, "-o", folder.file("out"), "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(files_below(folder / "out"),
              (std::vector<std::string>{"drop.mp4", "frames/drop.0000.exr", "frames/drop.0001.exr",
                                        "frames/drop.0002.exr", "preview/drop.0000.png",
                                        "preview/drop.0001.png", "preview/drop.0002.png",
                                        "report.json", "scene.toml", "trajectory.h5"}));
    const auto result = nlohmann::json::parse(run.out);
    EXPECT_EQ(result["render"]["rendered"], 3);
    EXPECT_EQ(result["simulate"]["rows"], 3);
    EXPECT_EQ(result, nlohmann::json::parse(content(folder / "out/report.json")));
}

TEST(Program, SameCommandAgainKeepsWhatIsThere) {
    const Folder folder("again");
    const auto scene = folder.write("drop.toml", small_scene(0.15));
    ASSERT_EQ(tesserae({"run", scene, "-o", folder.file("out")}).status, 0);
    const std::string frame = content(folder / "out/frames/drop.0001.exr");
    fs::remove(folder / "out/frames/drop.0001.exr");
    const auto kept = fs::last_write_time(folder / "out/frames/drop.0000.exr");
    const Outcome again = tesserae({"run", scene, "-o", folder.file("out"), "--json"});
    ASSERT_EQ(again.status, 0) << again.err;
    const auto result = nlohmann::json::parse(again.out);
    EXPECT_EQ(result["render"]["rendered"], 1);
    EXPECT_EQ(result["render"]["kept"], 2);
    EXPECT_EQ(content(folder / "out/frames/drop.0001.exr"), frame);
    EXPECT_EQ(fs::last_write_time(folder / "out/frames/drop.0000.exr"), kept);
}

TEST(Program, SameBytesAtAnyThreadCount) {
    const Folder folder("threads");
    const auto scene = folder.write("drop.toml", small_scene(0.3));
    ASSERT_EQ(tesserae({"run", scene, "-o", folder.file("1"), "--threads", "1"}).status, 0);
    for (const char* threads : {"2", "3", "8"}) {
        const auto run = tesserae({"run", scene, "-o", folder.file(threads), "--threads", threads});
        ASSERT_EQ(run.status, 0) << run.err;
        for (const std::string& file : files_below(folder / "1")) {
            if (file == "report.json") continue;  // holds times
            EXPECT_EQ(content(folder / "1" / file), content(folder / threads / file))
                << file << " with " << threads << " threads";
        }
    }
}

TEST(Program, FramesThatLookTheSameAreCopiedWithTheBytesOfRenderingThem) {
    const Folder folder("copied");
    // Rest, a turn of the camera in frame 2, rest again.
    const auto scene = folder.write("rest.toml", small_scene(0.35) + R"(
[[camera.key]]
time = 0.06
fourth = [0, 0, 0, 1]
[[camera.key]]
time = 0.14
fourth = [0.5, 0, 0, 1]
)");
    const std::vector<std::string> still = {"--set", "physics.gravity=[0,0,0,0]",
                                            "--set", "body.ball.velocity=[0,0,0,0]",
                                            "--set", "body.ball.angular_velocity={xw=0}"};
    const auto render = [&](const char* out, std::vector<std::string> more) {
        std::vector<std::string> line = {"render", scene, "-o", folder.file(out), "--json"};
        line.insert(line.end(), still.begin(), still.end());
        line.insert(line.end(), more.begin(), more.end());
        const Outcome run = tesserae(line);
        EXPECT_EQ(run.status, 0) << run.err;
        return nlohmann::json::parse(run.out)["render"];
    };
    const auto preview = [&](const std::string& out, int frame) {
        return content(folder / out / fmt::format("preview/rest.{:04}.png", frame));
    };
    const auto expect_alone_as_in = [&](const std::string& out, std::vector<std::string> more) {
        more.insert(more.end(), {"--frames", ""});
        for (const char* frame : {"1", "4", "6"}) {
            more.back() = frame;
            const std::string alone = out + frame;
            EXPECT_EQ(render(alone.c_str(), more)["rendered"], 1);
            for (const std::string name : {"frames/rest.000N.exr", "preview/rest.000N.png"}) {
                std::string file = name;
                file.replace(file.find('N'), 1, frame);
                EXPECT_EQ(content(folder / out / file), content(folder / alone / file)) << file;
            }
        }
    };
    // A copy is a frame in which nothing is random or the noise is locked.
    const std::vector<std::string> same[] = {{"--set", "render.lock_noise=true"},
                                             {"--samples", "1"}};
    for (const bool is_locked : {true, false}) {
        const std::vector<std::string>& more = same[is_locked ? 0 : 1];
        const std::string out = is_locked ? "locked" : "one";
        const auto whole = render(out.c_str(), more);
        EXPECT_EQ(whole["rendered"], 3);
        EXPECT_EQ(whole["copied"], 4);
        expect_alone_as_in(out, more);
        EXPECT_EQ(preview(out, 4), preview(out, 6));
        EXPECT_NE(preview(out, 1), preview(out, 4));
    }
    // Else frames have noise of their own, the same however they are rendered.
    const auto moving = render("moving", {});
    EXPECT_EQ(moving["rendered"], 7);
    EXPECT_EQ(moving["copied"], 0);
    expect_alone_as_in("moving", {});
    EXPECT_NE(preview("moving", 4), preview("moving", 6));
    EXPECT_EQ(preview("moving", 0), preview("locked", 0));
    render("seed", {"--set", "render.seed=1", "--frames", "0,4"});
    EXPECT_NE(preview("seed", 0), preview("moving", 0));
    EXPECT_NE(preview("seed", 4), preview("moving", 4));
}

TEST(Program, AnotherSceneInTheSameFolderIsRefused) {
    const Folder folder("mix");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const std::string out = folder.file("out");
    ASSERT_EQ(tesserae({"run", scene, "-o", out}).status, 0);
    const auto refused = [&](std::vector<std::string> words, const char* key) {
        const Outcome other = tesserae(words);
        EXPECT_EQ(other.status, 2);
        EXPECT_NE(other.err.find(key), std::string::npos) << other.err;
        words.push_back("--overwrite");
        EXPECT_EQ(tesserae(words).status, 0);
    };
    refused({"render", scene, "-o", out, "--samples", "3"}, "render.samples");
    refused({"run", folder.write("other.toml", small_scene(0.1)), "-o", out}, "scene.name");
    refused({"run", scene, "-o", out, "--set", "body.ball.radius=0.4"}, "radius");
}

TEST(Program, TrajectoryOfAnotherMotionIsRefused) {
    const Folder folder("motion");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    ASSERT_EQ(tesserae({"simulate", scene, "-o", folder.file("a.h5")}).status, 0);
    const std::string film = folder.file("film");
    const Outcome same = tesserae({"render", scene, "--trajectory", folder.file("a.h5"), "-o", film,
                                   "--set", "light.0.strength=1"});
    EXPECT_EQ(same.status, 0) << same.err;
    const Outcome other = tesserae({"render", scene, "--trajectory", folder.file("a.h5"), "-o",
                                    folder.file("film2"), "--set", "body.ball.radius=0.4"});
    EXPECT_EQ(other.status, 2);
    EXPECT_NE(other.err.find("radius"), std::string::npos) << other.err;
    EXPECT_TRUE(files_below(folder / "film2/frames").empty());
}

TEST(Program, TrajectoryWithoutTheStepsOfAFrameIsRefused) {
    const Folder folder("steps");
    const auto scene = folder.write("drop.toml", small_scene(0.3));
    ASSERT_EQ(tesserae({"simulate", scene, "-o", folder.file("a.h5"), "--store-every", "7"}).status,
              0);
    const auto render = [&](const char* frames, const char* out) {
        return tesserae({"render", scene, "--trajectory", folder.file("a.h5"), "--frames", frames,
                         "-o", folder.file(out)});
    };
    EXPECT_EQ(render("0", "x").status, 0);
    const Outcome lacking = render("1", "y");
    EXPECT_EQ(lacking.status, 2);
    EXPECT_NE(lacking.err.find("step 3"), std::string::npos) << lacking.err;
}

TEST(Program, WrongCommandLinesExitWithTwoAndSayWhy) {
    const Folder folder("usage");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const std::string out = folder.file("out");
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
        {{}, "subcommand"},
        {{"rnu", scene}, "rnu"},
        {{"run", scene}, "--output"},
        {{"run", "-o", out}, "scene"},
        {{"run", folder.file("none.toml"), "-o", out}, "none.toml"},
        {{"run", scene, "-o", out, "--threads", "0"}, "threads"},
        {{"run", scene, "-o", out, "--threads", "x"}, "threads"},
        {{"run", scene, "-o", out, "--size", "12"}, "1920x1080"},
        {{"run", scene, "-o", out, "--size", "0x4"}, "size"},
        {{"run", scene, "-o", out, "--samples", "0"}, "samples"},
        {{"run", scene, "-o", out, "--frames", "5"}, "frame 5"},
        {{"run", scene, "-o", out, "--frames", "x"}, "--frames x"},
        {{"run", scene, "-o", out, "--crop", "0,0,65,9"}, "crop"},
        {{"run", scene, "-o", out, "--integrator", "pat"}, "path"},
        {{"run", scene, "-o", out, "--intersector", "magic"}, "analytic"},
        {{"run", scene, "-o", out, "--set", "physics.iteration=2"}, "iterations"},
        {{"run", scene, "-o", out, "--unknown"}, "unknown"},
        {{"generate", "pil", "--bodies", "10"}, "did you mean \"pile\"?"},
        {{"generate", "pile", "--bodies", "0"}, "--bodies"},
        {{"submit", scene, "-o", out, "--for", "nothing"}, "commands"},
        {{"submit", scene, "-o", out, "--crop", "0,0,8,8"}, "a crop is no film"},
        {{"status", folder.file("none")}, "holds no film"},
        {{"info", folder.file("none")}, "none"},
        {{"simulate", scene, "-o", folder.file("x.h5"), "--store-every", "0"}, "store-every"},
    };
    for (const auto& [arguments, expected] : wrong) {
        const Outcome outcome = tesserae(arguments);
        EXPECT_EQ(outcome.status, 2) << expected << ": " << outcome.err;
        EXPECT_NE(outcome.err.find(expected), std::string::npos) << expected << ": " << outcome.err;
        EXPECT_EQ(outcome.out, "") << expected;
    }
    EXPECT_FALSE(fs::exists(out)) << "nothing is written for a wrong command line";
}

TEST(Program, HelpAndVersionGoToStandardOutput) {
    EXPECT_EQ(tesserae({"--help"}).status, 0);
    EXPECT_NE(tesserae({"run", "--help"}).out.find("--threads"), std::string::npos);
    EXPECT_EQ(tesserae({"--version"}).status, 0);
}

TEST(Program, OutputsThatCannotBeWrittenExitWithOneAndNameThePath) {
    const Folder folder("unwritable");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const auto blocked = folder.write("file", "a file where a folder is wanted");
    for (const auto& arguments :
         std::vector<std::vector<std::string>>{{"run", scene, "-o", blocked},
                                               {"run", scene, "-o", blocked + "/below"},
                                               {"simulate", scene, "-o", blocked + "/t.h5"},
                                               {"simulate", scene, "-o", blocked + "/below/t.h5"},
                                               {"view", scene, "-o", blocked + "/page.html"}}) {
        const Outcome outcome = tesserae(arguments);
        EXPECT_EQ(outcome.status, 1) << outcome.err;
        EXPECT_NE(outcome.err.find(arguments.back()), std::string::npos) << outcome.err;
    }
}

TEST(Program, FoldersOfOutputsAreMade) {
    const Folder folder("missing");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    EXPECT_EQ(tesserae({"simulate", scene, "-o", folder.file("a/b/t.h5")}).status, 0);
    EXPECT_TRUE(fs::exists(folder.file("a/b/t.h5")));
    EXPECT_EQ(tesserae({"view", scene, "-o", folder.file("c/page.html")}).status, 0);
    EXPECT_TRUE(fs::exists(folder.file("c/page.html")));
}

/// A full disk, as far as one can be had without one: files larger than `bytes` cannot be written.
Outcome with_file_limit(rlim_t bytes, const std::vector<std::string>& arguments) {
    rlimit before = {};
    getrlimit(RLIMIT_FSIZE, &before);
    rlimit limited = before;
    limited.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limited);
    Outcome outcome = tesserae(arguments);
    setrlimit(RLIMIT_FSIZE, &before);
    return outcome;
}

TEST(Program, FullDiskExitsWithOneAndLeavesNoFinalName) {
    const Folder folder("full");
    const auto scene = folder.write("drop.toml", small_scene(0.15));
    // Too small for the trajectory; for a frame; for a preview.
    ASSERT_EQ(tesserae({"simulate", scene, "-o", folder.file("whole.h5")}).status, 0);
    const Outcome simulated = with_file_limit(3000, {"simulate", scene, "-o", folder.file("t.h5")});
    EXPECT_EQ(simulated.status, 1) << simulated.err;
    EXPECT_NE(simulated.err.find("t.h5"), std::string::npos) << simulated.err;
    EXPECT_FALSE(fs::exists(folder / "t.h5"));
    for (rlim_t limit : {2500, 10000}) {
        const Outcome filmed =
            with_file_limit(limit, {"render", scene, "--trajectory", folder.file("whole.h5"),
                                    "--size", "320x240", "-o", folder.file("film")});
        EXPECT_EQ(filmed.status, 1) << filmed.err;
        EXPECT_NE(filmed.err.find("film"), std::string::npos) << filmed.err;
        EXPECT_TRUE(files_below(folder / "film/frames").empty());
    }
    // With room again the same command finishes.
    EXPECT_EQ(tesserae({"render", scene, "--trajectory", folder.file("whole.h5"), "--size",
                        "320x240", "-o", folder.file("film")})
                  .status,
              0);
}

TEST(Program, StandardOutputThatCannotBeWrittenIsAnError) {
    const Folder folder("stdout");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const std::string command =
        std::string(TESSERAE_PROGRAM) + " plan " + scene + " > /dev/full 2> " + folder.file("err");
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
    EXPECT_NE(content(folder / "err").find("standard output"), std::string::npos);
}

TEST(Program, PlanSaysWhatIsLeftOutAndWhy) {
    const Folder folder("plan");
    const auto still =
        folder.write("still.toml", "[[body]]\nshape = \"hypersphere\"\nradius = 1\n");
    const Outcome plan = tesserae({"plan", still, "--json"});
    ASSERT_EQ(plan.status, 0) << plan.err;
    const auto json = nlohmann::json::parse(plan.out);
    EXPECT_EQ(json["bodies"], 1);
    EXPECT_EQ(json["frames"], 1);
    EXPECT_EQ(json["decisions"][0]["part"], "physics");
    EXPECT_EQ(json["decisions"][0]["needed"], false);
}

}  // namespace
}  // namespace tesserae::scenes::testing
