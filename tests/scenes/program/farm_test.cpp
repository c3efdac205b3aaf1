// SPDX-License-Identifier: Apache-2.0
// Films for a farm: job scripts, and how far a film is. A real Slurm: tests/slurm.sh.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

int shell(const std::string& command) {
    const int status = std::system((command + " >/dev/null 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Farm, ItsCommandsMakeTheFilmOfALocalRun) {
    const Folder folder("it's a \"farm\" für");
    const auto scene = folder.write("small.toml", small_scene(0.4));
    const auto film = folder.file("film"), local = folder.file("local");
    ASSERT_EQ(tesserae({"run", scene, "-o", local, "--samples", "1"}).status, 0);
    const Outcome submit = tesserae(
        {"submit", scene, "-o", film, "--samples", "1", "--chunk", "3", "--for", "commands"});
    ASSERT_EQ(submit.status, 0) << submit.err;
    // What was submitted is made, whatever becomes of the scene.
    folder.write("small.toml", "broken");
    std::istringstream lines(submit.out);
    std::vector<std::string> commands;
    for (std::string line; std::getline(lines, line);) commands.push_back(line);
    ASSERT_EQ(commands.size(), 3u);
    EXPECT_EQ(shell(commands[0]), 1) << "there is no trajectory yet";
    ASSERT_EQ(
        tesserae({"simulate", film + "/submit/scene.toml", "-o", film + "/trajectory.h5"}).status,
        0);
    for (const std::string& command : commands) EXPECT_EQ(shell(command), 0) << command;
    EXPECT_EQ(tesserae({"status", film}).status, 0);
    for (const char* part : {"frames", "preview"})
        for (const std::string& file : files_below(fs::path(local) / part))
            EXPECT_EQ(content(fs::path(local) / part / file), content(fs::path(film) / part / file))
                << file;
    EXPECT_FALSE(fs::exists(film + "/report.json"));
    // Again: nothing is touched.
    const auto time = fs::last_write_time(film + "/frames/small.0000.exr");
    EXPECT_EQ(shell(commands[0]), 0);
    EXPECT_EQ(fs::last_write_time(film + "/frames/small.0000.exr"), time);
}

TEST(Farm, ScriptsAreThoseOfTheSceneAndTheOptions) {
    const Folder folder("farm");
    const auto scene = folder.write("small.toml", small_scene(1));
    std::vector<std::string> texts;
    for (const char* name : {"a", "b"}) {
        const auto film = folder.file(name);
        const Outcome submit =
            tesserae({"submit", scene, "-o", film, "--partition", "big mem", "--account", "me",
                      "--max-running", "7", "--cores", "3", "--sbatch", "--qos=low", "--sbatch",
                      "--nice", "--frames", "0-9x2"});
        ASSERT_EQ(submit.status, 0) << submit.err;
        std::string text;
        for (const std::string& file : files_below(film + "/submit"))
            text += content(film + "/submit/" + file);
        texts.push_back(text);
    }
    EXPECT_EQ(texts[0], texts[1]) << "no paths, dates or names of machines";
    for (const char* line :
         {"#SBATCH --partition='big mem'", "#SBATCH --account=me", "--cpus-per-task=3",
          "#SBATCH --qos=low", "#SBATCH --nice", "--array=0-0%7", "0-8x2"})
        EXPECT_NE(texts[0].find(line), std::string::npos) << line;
}

TEST(Status, TellsCompleteFromMissingFromOtherAndInvalid) {
    const Folder folder("status");
    const auto scene = folder.write("small.toml", small_scene(0.3));
    const auto film = folder.file("film"), other = folder.file("other");
    EXPECT_EQ(tesserae({"status", film}).status, 2);
    ASSERT_EQ(tesserae({"run", scene, "-o", film}).status, 0);
    ASSERT_EQ(tesserae({"run", scene, "-o", other, "--samples", "1"}).status, 0);
    const Outcome complete = tesserae({"status", film, "--json"});
    ASSERT_EQ(complete.status, 0) << complete.err;
    EXPECT_EQ(nlohmann::json::parse(complete.out)["complete"], 6);

    const std::string frame = film + "/frames/small.000";
    const std::string first = content(frame + "0.exr");
    fs::remove(frame + "1.exr");
    fs::remove(film + "/preview/small.0002.png");
    fs::copy(other + "/frames/small.0003.exr", frame + "3.exr",
             fs::copy_options::overwrite_existing);
    fs::resize_file(frame + "4.exr", fs::file_size(frame + "4.exr") - 1);
    std::ofstream(frame + "5.exr") << "no image";
    const Outcome bad = tesserae({"status", film, "--json"});
    EXPECT_EQ(bad.status, 1);
    const auto json = nlohmann::json::parse(bad.out);
    EXPECT_EQ(json["complete"], 1);
    EXPECT_EQ(json["missing"], nlohmann::json({1, 2}));
    EXPECT_EQ(json["other_scene"], nlohmann::json({3}));
    EXPECT_EQ(json["invalid"], nlohmann::json({4, 5}));
    EXPECT_TRUE(json["running"].is_null());

    // The command that it names finishes the rest, and no more.
    std::string command = json["command"];
    ASSERT_TRUE(command.starts_with("tesserae ")) << command;
    EXPECT_EQ(shell(TESSERAE_PROGRAM + command.substr(8)), 0) << command;
    EXPECT_EQ(tesserae({"status", film}).status, 0);
    EXPECT_EQ(content(frame + "0.exr"), first);
}

}  // namespace
}  // namespace tesserae::scenes::testing
