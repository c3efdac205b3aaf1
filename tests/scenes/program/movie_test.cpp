// SPDX-License-Identifier: Apache-2.0
// The film at the end, and what ffmpeg's own tools say of it.
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenes/process/shell_word.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

/// Of the first video stream, frames counted.
nlohmann::json stream_of(const std::string& file) {
    const std::string command =
        "ffprobe -v error -count_frames -print_format json -show_streams " + shell_word(file);
    FILE* pipe = popen(command.c_str(), "r");
    std::string text;
    for (char buffer[4096]; const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe);)
        text.append(buffer, n);
    pclose(pipe);
    return nlohmann::json::parse(text)["streams"][0];
}

class Movie : public ::testing::Test {
    const WithFilms films_;

  protected:
    Outcome run(std::vector<std::string> more, const char* command = "run") const {
        std::vector<std::string> words = {command, scene_, "-o", out_, "--samples", "1"};
        words.insert(words.end(), more.begin(), more.end());
        return tesserae(words);
    }
    void expect_movie(const std::string& file, int frames, const char* rate, int width,
                      int height) const {
        const auto stream = stream_of(file);
        EXPECT_EQ(stream["codec_name"], "h264");
        EXPECT_EQ(stream["pix_fmt"], "yuv420p");
        EXPECT_EQ(stream["nb_read_frames"], std::to_string(frames));
        EXPECT_EQ(stream["r_frame_rate"], rate);
        EXPECT_EQ(stream["width"], width);
        EXPECT_EQ(stream["height"], height);
        EXPECT_FALSE(fs::exists(file + ".partial"));
        // The index comes first, so that it plays while it loads.
        const std::string bytes = content(file);
        EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
    }

    const Folder folder_{"a film's \"folder\" \xc3\xa9"};
    const std::string scene_ = folder_.write("drop.toml", small_scene(0.6)),
                      out_ = folder_.file("out");
    const std::string movie_ = out_ + "/drop.mp4";
};

TEST_F(Movie, IsMadeOnceEveryFrameIsThere) {
    const Outcome part = run({"--size", "51x33", "--frames", "0-5"});
    ASSERT_EQ(part.status, 0) << part.err;
    EXPECT_NE(part.out.find("not made: 6 of 12 frames"), std::string::npos) << part.out;
    EXPECT_FALSE(fs::exists(movie_));
    ASSERT_EQ(run({"--size", "51x33"}).status, 0);
    expect_movie(movie_, 12, "20/1", 52, 34);
    const auto made = fs::last_write_time(movie_);
    ASSERT_EQ(run({"--size", "51x33"}).status, 0);
    EXPECT_EQ(fs::last_write_time(movie_), made) << "nothing new to show";
    // One frame of another look among them is no film, and no failure.
    const Outcome mixed =
        run({"--size", "51x33", "--set", "camera.field_of_view=20", "--frames", "5"});
    EXPECT_EQ(mixed.status, 0) << mixed.err;
    EXPECT_NE(mixed.out.find("not made: "), std::string::npos) << mixed.out;
    EXPECT_NE(mixed.out.find("is a frame of another scene"), std::string::npos) << mixed.out;
    // A change of look is a change of the film, and a preview alone is enough.
    ASSERT_EQ(run({"--size", "50x30"}).status, 0);
    expect_movie(movie_, 12, "20/1", 50, 30);
    fs::remove_all(out_ + "/frames");
    EXPECT_EQ(tesserae({"film", out_}).status, 0);
    expect_movie(movie_, 12, "20/1", 50, 30);
}

TEST_F(Movie, OfEverySecondFrameLastsAsLong) {
    ASSERT_EQ(run({"--size", "48x32", "--frames", "0-11x3"}, "render").status, 0);
    EXPECT_FALSE(fs::exists(movie_)) << "render makes no film";
    const Outcome film = tesserae({"film", out_, "--json"});
    ASSERT_EQ(film.status, 0) << film.err;
    EXPECT_EQ(nlohmann::json::parse(film.out)["frames"], 4);
    expect_movie(movie_, 4, "20/3", 48, 32);
    ASSERT_EQ(run({"--size", "48x32", "--draft"}).status, 0);
    expect_movie(out_ + "/draft/drop.mp4", 6, "10/1", 16, 12);
}

TEST_F(Movie, RefusesWhatIsNoFilm) {
    const auto refused = [&](const std::string& folder, const std::string& words) {
        const Outcome film = tesserae({"film", folder});
        EXPECT_EQ(film.status, 2);
        EXPECT_NE(film.err.find(words), std::string::npos) << film.err;
        EXPECT_FALSE(fs::exists(movie_ + ".partial"));
    };
    refused(folder_.file("none"), "has no scene.toml");
    ASSERT_EQ(run({"--size", "48x32", "--frames", "3"}, "render").status, 0);
    refused(out_, "holds 1 of a film's frames");
    ASSERT_EQ(run({"--size", "48x32", "--frames", "4,6"}, "render").status, 0);
    refused(out_, "the preview of frame 5 is missing");
    ASSERT_EQ(run({"--size", "48x32", "--frames", "5"}, "render").status, 0);
    // Without its image a damaged preview is not mended.
    const std::string image = out_ + "/frames/drop.0005.exr", bytes = content(image);
    fs::remove(image);
    const std::string preview = out_ + "/preview/drop.0005.png", whole = content(preview);
    folder_.write("out/preview/drop.0005.png", "no picture");
    refused(out_, "is no PNG picture");
    folder_.write("out/preview/drop.0005.png", whole.substr(0, 60));
    refused(out_, "drop.0005.png: is cut off");
    folder_.write("out/preview/drop.0005.png", whole);
    folder_.write("out/frames/drop.0005.exr", bytes);
    ASSERT_EQ(tesserae({"film", out_}).status, 0);
    // A frame of another look among them.
    ASSERT_EQ(run({"--size", "48x32", "--set", "camera.field_of_view=20", "--frames", "5"}).status,
              0);
    refused(out_, "is a frame of another scene");
}

}  // namespace
}  // namespace tesserae::scenes::testing
