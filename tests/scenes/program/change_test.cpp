// SPDX-License-Identifier: Apache-2.0
// A change of mind: `run` again in the same folder with another look, or for longer.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

class Change : public ::testing::Test {
  protected:
    struct Result {
        nlohmann::json json;
        std::string err;
    };
    /// `run` with these words more, into a folder.
    Result run(const std::string& out, std::vector<std::string> more) const {
        std::vector<std::string> words = {"run", scene_, "-o", out, "--json", "--size", "48x32"};
        if (std::find(more.begin(), more.end(), "--samples") == more.end())
            more.insert(more.end(), {"--samples", "1"});
        words.insert(words.end(), more.begin(), more.end());
        const Outcome outcome = tesserae(words);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        return {outcome.status == 0 ? nlohmann::json::parse(outcome.out) : nlohmann::json(),
                outcome.err};
    }
    /// What `run` has left is what it would have made from nothing.
    void expect_as_new(const std::vector<std::string>& more, const char* name) const {
        const std::string fresh = folder_.file(name);
        run(fresh, more);
        const auto files = files_below(fs::path(fresh) / "frames");
        EXPECT_EQ(files_below(fs::path(out_) / "frames"), files);
        for (const std::string& file : files)
            EXPECT_EQ(content(out_ + "/frames/" + file), content(fresh + "/frames/" + file))
                << file;
        EXPECT_EQ(content(out_ + "/scene.toml"), content(fresh + "/scene.toml"));
    }
    void expect_kept_for_longer(const std::vector<std::vector<std::string>>& looks);
    fs::file_time_type trajectory_time() const {
        return fs::last_write_time(out_ + "/trajectory.h5");
    }

    const Folder folder_{"change"};
    const std::string scene_ = folder_.write("drop.toml", small_scene(0.3)),
                      out_ = folder_.file("out");
};
using ChangeSlow = Change;

TEST_F(Change, OfLookKeepsTheTrajectory) {
    const auto first = run(out_, {}).json;
    const int frames = first["render"]["rendered"];
    ASSERT_GE(frames, 5);
    const auto made = trajectory_time();
    int number = 0;
    for (const std::vector<std::string>& look :
         {std::vector<std::string>{"--set", "camera.field_of_view=33"},
          {"--set", "light.0.strength=1.5"},
          {"--set", "body.ball.visible=false"},
          {"--samples", "2"},
          {"--set", "render.frames_per_second=10"}}) {
        const Result again = run(out_, look);
        EXPECT_EQ(again.json["simulate"]["first_step"], again.json["simulate"]["last_step"]);
        EXPECT_EQ(again.json["render"]["kept"], 0) << look.back();
        EXPECT_NE(again.err.find("rendered again"), std::string::npos) << again.err;
        EXPECT_EQ(trajectory_time(), made);
        if (look.back() != "render.frames_per_second=10")
            expect_as_new(look, fmt::format("new{}", number++).c_str());
        const Result same = run(out_, look);
        EXPECT_EQ(same.json["render"]["rendered"], 0);
        EXPECT_EQ(same.err, "");
    }
}

TEST_F(Change, OfShutterSimulatesTheSameMotionAgain) {
    run(out_, {});
    const Result again = run(out_, {"--set", "camera.shutter=0.5"});
    EXPECT_NE(again.err.find("lacks steps that the frames need"), std::string::npos) << again.err;
    EXPECT_EQ(again.json["render"]["kept"], 0);
    expect_as_new({"--set", "camera.shutter=0.5"}, "new");
}

void Change::expect_kept_for_longer(const std::vector<std::vector<std::string>>& looks) {
    for (const std::vector<std::string>& look : looks) {
        fs::remove_all(out_);
        auto longer = look;
        longer.insert(longer.end(), {"--set", "physics.duration=0.6"});
        const int before = run(out_, look).json["render"]["rendered"];
        const Result more = run(out_, longer);
        EXPECT_GT(more.json["simulate"]["first_step"], 0);
        EXPECT_GT(more.json["simulate"]["last_step"], more.json["simulate"]["first_step"]);
        // The last frame shows that there was none after it.
        EXPECT_EQ(more.json["render"]["kept"], before - (look.empty() ? 0 : 1));
        expect_as_new(longer, look.empty()                        ? "new"
                              : look.back() == "camera.shutter=1" ? "new1"
                                                                  : "new2");
        // And back: what is there serves; the frames after it stay.
        const Result shorter = run(out_, look);
        EXPECT_EQ(shorter.json["simulate"]["last_step"], shorter.json["simulate"]["first_step"]);
        EXPECT_EQ(shorter.json["render"]["rendered"], look.empty() ? 0 : 1);
    }
}

TEST_F(Change, OfDurationKeepsFrames) {
    expect_kept_for_longer({{}, {"--set", "render.channels=[\"color\", \"motion\"]"}});
}
TEST_F(ChangeSlow, OfDurationKeepsFrames) {
    expect_kept_for_longer({{"--set", "camera.shutter=1"}});
}

TEST_F(Change, OverwriteReplacesOnlyWhatDiffers) {
    const int frames = run(out_, {}).json["render"]["rendered"];
    const auto made = trajectory_time();
    const Result same = run(out_, {"--overwrite"});
    EXPECT_EQ(same.json["render"]["kept"], frames);
    EXPECT_EQ(trajectory_time(), made);
    const Result look = run(out_, {"--overwrite", "--set", "camera.field_of_view=33"});
    EXPECT_EQ(look.json["render"]["rendered"], frames);
    EXPECT_EQ(trajectory_time(), made);
    const Result longer = run(
        out_, {"--overwrite", "--set", "camera.field_of_view=33", "--set", "physics.duration=0.6"});
    EXPECT_EQ(longer.json["simulate"]["first_step"], look.json["simulate"]["last_step"]);
    EXPECT_EQ(longer.json["render"]["kept"], frames);
    const Result motion = run(out_, {"--overwrite", "--set", "physics.gravity=[0, -5, 0, 0]"});
    EXPECT_EQ(motion.json["simulate"]["first_step"], 0);
    EXPECT_EQ(motion.json["render"]["kept"], 0);
}

TEST_F(Change, ADraftSharesTheTrajectory) {
    const Result draft = run(out_, {"--draft"});
    EXPECT_FALSE(fs::exists(out_ + "/frames"));
    const auto files = files_below(fs::path(out_) / "draft/frames");
    const int drafted = draft.json["render"]["rendered"];
    ASSERT_GE(drafted, 3);
    ASSERT_EQ(files.size(), static_cast<std::size_t>(drafted));
    EXPECT_EQ(files[1], "drop.0002.exr");
    const auto made = trajectory_time();
    const Result film = run(out_, {});
    EXPECT_EQ(film.json["simulate"]["first_step"], film.json["simulate"]["last_step"]);
    EXPECT_GE(film.json["render"]["rendered"], 2 * drafted - 1);
    EXPECT_EQ(trajectory_time(), made);
    expect_as_new({}, "new");
    // A draft of the finished film changes nothing of it.
    EXPECT_EQ(run(out_, {"--draft"}).json["render"]["kept"], drafted);
    EXPECT_EQ(run(out_, {}).json["render"]["rendered"], 0);
}

TEST_F(Change, ADraftReplacesItselfAndNoFilm) {
    const std::vector<std::string> slow = {"--draft", "--set", "physics.gravity=[0, -5, 0, 0]"};
    const int drafted = run(out_, {"--draft"}).json["render"]["rendered"];
    // Other light, other motion, other bodies: all is made again, without being asked to.
    EXPECT_EQ(
        run(out_, {"--draft", "--set", "render.exposure=1", "--set", "camera.field_of_view=33"})
            .json["render"]["rendered"],
        drafted);
    EXPECT_EQ(run(out_, slow).json["render"]["rendered"], drafted);
    EXPECT_EQ(run(out_, {"--draft"}).json["simulate"]["first_step"], 0);
    // The film's trajectory stays, and so does the film.
    run(out_, {});
    const auto made = trajectory_time();
    std::vector<std::string> command = {"run", scene_, "-o", out_};
    command.insert(command.end(), slow.begin(), slow.end());
    EXPECT_EQ(tesserae(command).status, 2);
    EXPECT_EQ(trajectory_time(), made);
    command.push_back("--overwrite");
    const Outcome refused = tesserae(command);
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("another folder"), std::string::npos) << refused.err;
    EXPECT_EQ(trajectory_time(), made);
    EXPECT_EQ(run(out_, {}).json["render"]["rendered"], 0) << "the film is as it was";
}

/// It may have taken hours.
TEST_F(Change, ADraftReplacesNoTrajectoryThatItHasNotMade) {
    ASSERT_EQ(tesserae({"simulate", scene_, "-o", out_ + "/trajectory.h5"}).status, 0);
    run(out_, {"--draft"});
    const auto made = trajectory_time();
    EXPECT_EQ(tesserae({"run", scene_, "-o", out_, "--draft", "--size", "48x32", "--set",
                        "physics.gravity=[0, -5, 0, 0]"})
                  .status,
              2);
    EXPECT_EQ(trajectory_time(), made);
}

TEST_F(Change, ADraftsFilmHasItsOwnFrames) {
    const WithFilms films;
    const int drafted = run(out_, {"--draft"}).json["render"]["rendered"];
    // A frame more does not spoil it.
    run(out_, {"--draft", "--frames", "1"});
    EXPECT_EQ(run(out_, {"--draft", "--set", "camera.field_of_view=33"}).json["film"]["frames"],
              drafted);
}

TEST_F(Change, AFolderThatIsNoDraftIsNotWrittenInto) {
    const fs::path foreign = fs::path(out_) / "draft";
    fs::create_directories(foreign);
    std::ofstream(foreign / "notes.txt") << "mine";
    const Outcome draft = tesserae({"run", scene_, "-o", out_, "--draft"});
    EXPECT_EQ(draft.status, 2);
    EXPECT_NE(draft.err.find("no draft"), std::string::npos) << draft.err;
    EXPECT_EQ(files_below(out_), std::vector<std::string>{"draft/notes.txt"});
    fs::remove(foreign / "notes.txt");
    EXPECT_EQ(tesserae({"run", scene_, "-o", out_, "--draft", "--size", "48x32"}).status, 0);
}

}  // namespace
}  // namespace tesserae::scenes::testing
