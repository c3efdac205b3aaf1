// SPDX-License-Identifier: Apache-2.0
// Some frames of a film: the simulation goes as far as they need, and on from there later.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <random>

#include "tests/scenes/program/program.hpp"
#include "tests/scenes/trajectory/datasets.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// 20 frames, 3 steps apart: the last needs step 57.
constexpr double kDuration = 1;
constexpr int kLastStep = 57;

nlohmann::json result_of(Words words, const Words& more = {}) {
    words.insert(words.end(), more.begin(), more.end());
    words.push_back("--json");
    const Outcome outcome = tesserae(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out, nullptr, false);
}

/// How often the stage that begins a step is in a trace.
int steps_in(const std::string& trace) {
    const auto json = nlohmann::json::parse(content(trace));
    int count = 0;
    for (const auto& event : json["traceEvents"]) count += event["name"] == "advance_first_half";
    return count;
}

class FirstFrames : public ::testing::Test {
  protected:
    nlohmann::json run(const std::string& to, const Words& more = {}) const {
        return result_of({"run", scene_, "-o", folder_.file(to)}, more);
    }
    std::string trajectory(const std::string& in) const {
        return folder_.file(in + "/trajectory.h5");
    }

    /// Runs the film at once, and then in another folder some frames after others and all the rest.
    void expect_straight_bytes(const Words& settings, const Words& lists) const {
        run("straight", settings);
        std::uint64_t last = 0;
        for (const std::string& frames : lists) {
            Words more = settings;
            more.insert(more.end(), {"--frames", frames});
            const auto report = run("parts", more)["simulate"];
            EXPECT_EQ(report["first_step"], last) << "no step is taken twice";
            last = report["last_step"];
        }
        const std::string straight = trajectory("straight"), parts = trajectory("parts");
        EXPECT_NE(different_datasets(straight, parts), "");
        for (const std::string& file : files_below(folder_ / "parts/frames"))
            EXPECT_EQ(content(folder_ / "parts/frames" / file),
                      content(folder_ / "straight/frames" / file))
                << file;
        EXPECT_EQ(run("parts", settings)["simulate"]["first_step"], last);
        EXPECT_EQ(different_datasets(straight, parts), "");
        EXPECT_EQ(tesserae({"diff", straight, parts}).status, 0);
        EXPECT_EQ(tesserae({"diff", folder_.file("straight"), folder_.file("parts")}).status, 0);
        EXPECT_FALSE(fs::exists(parts + ".partial"));
    }

    const Folder folder_{"first"};
    const std::string scene_ = folder_.write("heap.toml", small_scene(kDuration));
};

TEST_F(FirstFrames, TakeTheStepsToTheLastOfThemAlone) {
    struct Case {
        const char* frames;
        int last, rows;
        Words settings;
    };
    const Case cases[] = {
        {"0", 0, 1, {}},
        {"3,1", 9, 4, {}},
        {"4", 13, 10, {"--set", "camera.shutter=0.3"}},  // it closes at step 12.9
        {"4", 15, 6, {"--set", "render.channels=[\"color\", \"motion\"]"}},
        {"4", 12, 5, {"--store-every", "3"}},
        {"19", kLastStep, 20, {}},
    };
    int number = 0;
    for (const Case& c : cases) {
        const std::string to = std::to_string(number++), trace = folder_.file("trace.json");
        Words more = {"--frames", c.frames, "--trace", trace};
        more.insert(more.end(), c.settings.begin(), c.settings.end());
        const auto report = run(to, more)["simulate"];
        EXPECT_EQ(report["last_step"], c.last) << c.frames;
        EXPECT_EQ(report["rows"], c.rows) << c.frames;
        EXPECT_EQ(steps_in(trace), c.last) << c.frames;
        const auto info = result_of({"info", trajectory(to)});
        EXPECT_EQ(info["last_step"], c.last);
        EXPECT_EQ(info["complete"], report["last_step"] == report["steps_to_last_frame"]);
    }
}

TEST_F(FirstFrames, HaveTheBytesOfTheWholeFilmAndItsTrajectoryGoesOn) {
    expect_straight_bytes({"--set", "physics.duration=0.35", "--set", "camera.shutter=0.8"},
                          {"3,1", "2"});
}

TEST_F(FirstFrames, LeaveALongerTrajectoryAsItIs) {
    run("film");
    const std::string whole = content(trajectory("film"));
    for (const Words& more : {Words{"--frames", "0"}, Words{"--frames", "0", "--overwrite"},
                              Words{"--frames", "3", "--set", "render.frames_per_second=10"},
                              Words{"--frames", "1", "--draft"}}) {
        run("film", more);
        EXPECT_EQ(content(trajectory("film")), whole);
    }
    result_of({"simulate", scene_, "-o", trajectory("film"), "--frames", "2"});
    EXPECT_EQ(content(trajectory("film")), whole);
    EXPECT_FALSE(fs::exists(trajectory("film") + ".partial"));
    // Frames between its steps need others: these go as far as it did.
    const auto other =
        run("film", {"--frames", "1", "--set", "render.frames_per_second=25"})["simulate"];
    EXPECT_EQ(other["last_step"], kLastStep);
    // `render` alone is no less careful.
    const Words render = {"render", scene_, "-o", folder_.file("stills")};
    result_of(render);
    const std::string stills = content(trajectory("stills"));
    result_of(render, {"--frames", "1"});
    EXPECT_EQ(content(trajectory("stills")), stills);
}

TEST_F(FirstFrames, AreEnoughForAPageAndForMeshes) {
    const std::string page = folder_.file("page.html"), moved = folder_.file("page.h5");
    const auto view = [&](const Words& more) {
        return result_of({"view", scene_, "-o", page}, more);
    };
    EXPECT_EQ(view({"--frames", "2"})["moments"], 1);
    EXPECT_EQ(TrajectoryReader(moved).steps().back(), 6u);
    EXPECT_EQ(result_of({"view", moved, "-o", folder_.file("there.html")})["moments"], 3)
        << "a page of a trajectory that ends early shows what there is";
    const Words meshes = {"export", moved, "--format", "ply", "-o", folder_.file("meshes")};
    EXPECT_EQ(result_of(meshes, {"--frames", "1-2"})["written"], 2);
    const Outcome all = tesserae(meshes);
    EXPECT_EQ(all.status, 2);
    EXPECT_NE(all.err.find("ends at step 6 of 57"), std::string::npos) << all.err;
    EXPECT_EQ(view({})["moments"], 20);
    const std::string whole = content(moved);
    for (const Words& more :
         {Words{"--frames", "2"}, Words{"--frames", "2", "--set", "render.frames_per_second=10"}}) {
        EXPECT_EQ(view(more)["moments"], 1);
        EXPECT_EQ(content(moved), whole);
    }
}

TEST_F(FirstFrames, ArePlannedForAlone) {
    const auto whole = result_of({"plan", scene_});
    const auto plan = result_of({"plan", scene_, "--frames", "3,1"});
    EXPECT_EQ(whole["steps_to_last_frame"], kLastStep);
    EXPECT_EQ(plan["steps_to_last_frame"], 9);
    EXPECT_EQ(plan["steps"], whole["steps"]);
    EXPECT_EQ(plan["frames"], 20);
    EXPECT_EQ(plan["frames_asked"], 2);
    EXPECT_EQ(plan["view_rays"].get<int>() * 10, whole["view_rays"]);
    EXPECT_LT(plan["trajectory_bytes"], whole["trajectory_bytes"]);
    EXPECT_EQ(plan["measured"][0], "9 of 9 steps");
    const Outcome wrong = tesserae({"plan", scene_, "--frames", "20"});
    EXPECT_EQ(wrong.status, 2);
    EXPECT_NE(wrong.err.find("its frames are 0 to 19"), std::string::npos) << wrong.err;
}

TEST_F(FirstFrames, AreFollowedByTheCommandThatStatusTells) {
    run("film", {"--frames", "0"});
    const Outcome status = tesserae({"status", folder_.file("film"), "--json"});
    EXPECT_EQ(status.status, 1);
    EXPECT_NE(status.out.find("tesserae simulate"), std::string::npos) << status.out;
    result_of({"simulate", folder_.file("film/scene.toml"), "-o", trajectory("film")});
    const Outcome whole = tesserae({"status", folder_.file("film"), "--json"});
    EXPECT_EQ(whole.out.find("tesserae simulate"), std::string::npos) << whole.out;
}

using FirstFramesSlow = FirstFrames;

TEST_F(FirstFramesSlow, HaveTheBytesOfTheWholeFilmWhateverItHas) {
    const Words kinds[] = {{},
                           {"--set", "camera.shutter=0.8", "--set", "physics.sleeping=true"},
                           {"--set", "render.channels=[\"color\", \"motion\"]", "--threads", "1"}};
    for (const Words& settings : kinds) {
        expect_straight_bytes(settings, {"0", "3,1", "2", "8"});
        for (const char* folder : {"straight", "parts"}) fs::remove_all(folder_ / folder);
    }
}

/// Whoever kills it: what a longer run has stored stays, and what follows has the straight bytes.
TEST_F(FirstFramesSlow, KillsLoseNothing) {
    const Folder& folder = folder_;
    const auto scene = folder.write("long.toml", small_scene(20));
    const std::string straight = folder.file("straight.h5"), file = folder.file("film.h5");
    const auto simulation = [&](const std::string& to, const Words& more) {
        Words words = {"simulate", scene, "-o", to};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    const Outcome whole = tesserae(simulation(straight, {}));
    ASSERT_EQ(whole.status, 0);
    std::mt19937 random(5);
    int killed = 0;
    for (int i = 0; i < 8; ++i) {
        fs::remove(file);
        fs::remove(file + ".partial");
        // A run of all or of the first half is killed, then a few frames are asked for.
        const int percent = std::uniform_int_distribution(5, 60)(random);
        const int delay = whole.milliseconds * percent / 100;
        const Words half = i % 2 == 0 ? Words{} : Words{"--frames", "200"};
        if (tesserae(simulation(file, half), SIGKILL, delay).status == 0) continue;
        std::uint64_t rows = 0;
        if (fs::exists(file + ".partial") && fs::file_size(file + ".partial") > 0)
            rows = TrajectoryReader(file + ".partial").rows();
        ++killed;
        const Outcome few = tesserae(simulation(file, {"--frames", "2"}));
        ASSERT_EQ(few.status, 0) << few.err;
        EXPECT_GE(TrajectoryReader(file).rows(), std::max<std::uint64_t>(3, rows));
        EXPECT_FALSE(fs::exists(file + ".partial"));
        // Once more amid what goes on.
        const std::string finished = content(file);
        if (tesserae(simulation(file, {}), SIGKILL, delay).status != 0 &&
            fs::exists(file + ".partial")) {
            EXPECT_EQ(content(file), finished);
            const Outcome again = tesserae(simulation(file, {"--frames", "1"}));
            EXPECT_EQ(again.status, 0) << again.err;
            EXPECT_EQ(content(file), finished);
        }
        const Outcome rest = tesserae(simulation(file, {}));
        ASSERT_EQ(rest.status, 0) << rest.err;
        EXPECT_EQ(different_datasets(straight, file), "") << "seed 5, kill " << i;
    }
    EXPECT_GE(killed, 3);
}

}  // namespace
}  // namespace tesserae::scenes::testing
