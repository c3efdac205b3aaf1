// SPDX-License-Identifier: Apache-2.0
// What is damaged is made again, and what is left over goes: frames, previews, parts, films.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

class Damage : public ::testing::Test {
  protected:
    Outcome run(std::vector<std::string> more, const char* command = "run") const {
        std::vector<std::string> words = {command, scene_,      "-o", out_,        "--size",
                                          "48x32", "--samples", "1",  "--threads", "1"};
        words.insert(words.end(), more.begin(), more.end());
        return tesserae(words);
    }
    std::string frame(int number) const {
        return out_ + "/frames/drop.000" + std::to_string(number) + ".exr";
    }
    std::string preview(int number) const {
        return out_ + "/preview/drop.000" + std::to_string(number) + ".png";
    }
    static void write(const std::string& file, const std::string& bytes) {
        std::ofstream(file, std::ios::binary) << bytes;
    }

    const Folder folder_{"damage"};
    const std::string scene_ = folder_.write("drop.toml", small_scene(0.25)),
                      out_ = folder_.file("out");
};

/// In what ways a file may be damaged.
std::vector<std::string> damaged(const std::string& whole) {
    return {"",
            "no such file",
            std::string(whole.size(), '\0'),
            whole.substr(0, 8),
            whole.substr(0, whole.size() / 3),
            whole.substr(0, whole.size() - 3)};
}

TEST_F(Damage, AnUnreadableFrameIsMadeAgainAndStopsNoOther) {
    ASSERT_EQ(run({}).status, 0);
    const std::string whole = content(frame(2));
    for (const std::string& bytes : damaged(whole)) {
        write(frame(2), bytes);
        fs::remove(frame(4));
        EXPECT_EQ(tesserae({"status", out_}).status, 1);
        const Outcome again = run({"--trajectory", out_ + "/trajectory.h5"}, "render");
        ASSERT_EQ(again.status, 0) << again.err;
        EXPECT_NE(again.err.find("drop.0002.exr"), std::string::npos) << "named: " << again.err;
        EXPECT_EQ(content(frame(2)), whole);
        EXPECT_TRUE(fs::exists(frame(4)));
        EXPECT_EQ(tesserae({"status", out_}).status, 0);
    }
    // The command that status gives does without --overwrite.
    write(frame(2), "");
    const Outcome status = tesserae({"status", out_});
    EXPECT_EQ(status.out.find("--overwrite"), std::string::npos) << status.out;
}

TEST_F(Damage, APreviewIsMadeAgainFromItsImage) {
    ASSERT_EQ(run({"--set", "render.exposure=1.5"}).status, 0);
    const std::string whole = content(preview(2)), image = content(frame(2));
    std::vector<std::string> ways = damaged(whole);
    std::string flipped = whole;
    flipped[whole.size() - 30] ^= 0x10;
    ways.push_back(flipped);
    const auto expect_mended = [&](const Outcome& again) {
        ASSERT_EQ(again.status, 0) << again.err;
        EXPECT_NE(again.err.find("drop.0002.png"), std::string::npos) << again.err;
        EXPECT_EQ(content(preview(2)), whole) << "the bytes of rendering it";
        EXPECT_EQ(content(frame(2)), image);
    };
    for (const std::string& bytes : ways) {
        write(preview(2), bytes);
        EXPECT_EQ(tesserae({"status", out_}).status, 1);
        expect_mended(tesserae({"film", out_}));
        EXPECT_EQ(tesserae({"status", out_}).status, 0);
        write(preview(2), bytes);
        expect_mended(run({"--set", "render.exposure=1.5"}));
    }
    // One that is missing is mended too; without its image it is named.
    fs::remove(preview(2));
    EXPECT_EQ(tesserae({"film", out_}).status, 0);
    EXPECT_EQ(content(preview(2)), whole);
    fs::remove(frame(2));
    write(preview(2), whole.substr(0, 100));
    const Outcome film = tesserae({"film", out_});
    EXPECT_EQ(film.status, 2);
    EXPECT_NE(film.err.find("drop.0002.png"), std::string::npos) << film.err;
}

/// An image without colour has nothing to make a preview from: the frame is rendered again.
TEST_F(Damage, APreviewOfAnImageWithoutColourIsRendered) {
    const std::vector<std::string> more = {"--set", "render.channels=[\"depth\"]"};
    ASSERT_EQ(run(more).status, 0);
    const std::string whole = content(preview(2));
    write(preview(2), "");
    ASSERT_EQ(run(more).status, 0);
    EXPECT_EQ(content(preview(2)), whole);
}

TEST_F(Damage, ACutImageHasNoSummary) {
    ASSERT_EQ(run({"--frames", "0"}).status, 0);
    ASSERT_EQ(tesserae({"info", frame(0)}).status, 0);
    const std::string whole = content(frame(0));
    for (const double part : {0.1, 0.5, 0.8, 0.999}) {
        write(frame(0),
              whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
        const Outcome info = tesserae({"info", frame(0)});
        EXPECT_EQ(info.status, 2) << part;
        EXPECT_NE(info.err.find("drop.0000.exr"), std::string::npos) << info.err;
        EXPECT_EQ(info.out, "");
    }
}

/// The film is another when its previews are, whatever the clock said.
TEST_F(Damage, AFilmOfOtherPreviewsIsMadeAgain) {
    const WithFilms films;
    ASSERT_EQ(run({}).status, 0);
    const std::string movie = out_ + "/drop.mp4", first = content(movie);
    for (const int hours : {-48, 48}) {
        fs::last_write_time(movie, fs::file_time_type::clock::now() + std::chrono::hours(hours));
        const auto time = fs::last_write_time(movie);
        ASSERT_EQ(run({}).status, 0);
        EXPECT_EQ(fs::last_write_time(movie), time) << "nothing changed";
        ASSERT_EQ(run({"--set", "camera.field_of_view=" + std::to_string(60 + hours / 24)}).status,
                  0);
        EXPECT_NE(content(movie), first);
        ASSERT_EQ(run({}).status, 0);
        EXPECT_EQ(content(movie).substr(0, 2000), first.substr(0, 2000));
    }
}

TEST_F(Damage, AFilmTellsWhatItLacks) {
    const WithFilms films;
    const auto says = [&](const std::string& words) {
        const Outcome film = tesserae({"film", out_});
        EXPECT_EQ(film.status, 0) << film.err;
        EXPECT_NE(film.err.find(words), std::string::npos) << film.err;
    };
    ASSERT_EQ(run({"--frames", "2-4"}).status, 0);
    says("2 of 5 frames are missing in the film: 0-1");
    fs::remove_all(out_);
    ASSERT_EQ(run({"--frames", "0-2"}).status, 0);
    says("2 of 5 frames are missing in the film: 3-4");
    fs::remove_all(out_);
    ASSERT_EQ(run({"--frames", "0-4x2"}).status, 0);
    says("2 of 5 frames are missing in the film: 1,3");
    // A draft has every second frame, as it was asked for.
    ASSERT_EQ(run({"--draft"}).status, 0);
    EXPECT_EQ(tesserae({"film", out_ + "/draft"}).err, "");
    EXPECT_EQ(tesserae({"status", out_ + "/draft"}).status, 0);
}

}  // namespace
}  // namespace tesserae::scenes::testing
