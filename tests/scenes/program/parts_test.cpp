// SPDX-License-Identifier: Apache-2.0
// A frame rendered in parts and joined is the frame rendered at once.
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <memory>
#include <thread>

#include "core/file/file_writer.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> part_words(const std::string& scene, const std::string& out, int k, int n,
                                    const std::vector<std::string>& more) {
    std::vector<std::string> words = {
        "render", scene, "-o", out, "--tiles", std::to_string(k) + "/" + std::to_string(n)};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// A still: no trajectory is needed.
std::string still_scene() { return small_scene(0); }

void expect_same_frame(const std::string& whole, const std::string& joined) {
    for (const char* file : {"/frames/still.0000.exr", "/preview/still.0000.png"}) {
        ASSERT_TRUE(fs::exists(joined + file)) << file;
        EXPECT_EQ(content(whole + file), content(joined + file)) << file;
    }
    EXPECT_EQ(files_below(joined), files_below(whole)) << "no part is left";
}

/// @param most   parts: settings with more are left out
void expect_parts_join(int most) {
    const Folder folder("parts");
    const auto scene = folder.write("still.toml", still_scene());
    struct Setting {
        std::vector<std::string> words;
        std::vector<int> counts;  ///< of parts
    };
    // 12 tiles, or 48, 1, 9, 12, 12, 250: fewer than parts, as many, more.
    const std::vector<Setting> settings = {
        {{}, {1, 3, 17}},
        {{"--set", "render.tile=8"}, {5, 17}},
        {{"--set", "render.tile=512"}, {1, 3}},
        {{"--crop", "5,3,50,41"}, {3, 12}},
        {{"--set", "render.noise_target=0.01", "--set", "render.max_samples=16"}, {3}},
        {{"--integrator", "path", "--set",
          "render.channels=[\"color\", \"cryptomatte\", \"light\"]"},
         {5}},
        {{"--set", "render.sky=\"transparent\""}, {3}},
        {{"--size", "2000x20", "--samples", "1"}, {3}}};
    int number = 0;
    for (const auto& [every, counts] : settings) {
        const auto whole = folder.file("whole" + std::to_string(number));
        std::vector<std::string> words = {"render", scene, "-o", whole};
        words.insert(words.end(), every.begin(), every.end());
        ASSERT_EQ(tesserae(words).status, 0);
        for (const int n : counts) {
            if (n > most) continue;
            const auto out =
                folder.file("parts" + std::to_string(number) + "-" + std::to_string(n));
            // In any order, by any number of threads.
            for (int k = n; k >= 1; --k) {
                auto more = every;
                more.insert(more.end(), {"--threads", std::to_string(1 + k % 3)});
                const Outcome part = tesserae(part_words(scene, out, k, n, more));
                ASSERT_EQ(part.status, 0) << part.err;
            }
            EXPECT_FALSE(fs::exists(out + "/frames/still.0000.exr"));
            const Outcome join = tesserae({"join", out});
            ASSERT_EQ(join.status, 0) << join.err;
            expect_same_frame(whole, out);
        }
        ++number;
    }
}

TEST(Parts, JoinToTheBytesOfASingleRun) { expect_parts_join(12); }
TEST(PartsSlow, JoinToTheBytesOfASingleRun) { expect_parts_join(17); }

TEST(Parts, WaitForThoseThatBeginTheFolderAtTheSameTime) {
    const Folder folder("begin");
    const auto scene = folder.write("still.toml", still_scene());
    const auto done = folder.file("done"), out = folder.file("out");
    ASSERT_EQ(tesserae(part_words(scene, done, 1, 2, {})).status, 0);
    const std::string effective = content(done + "/scene.toml");
    // Another process writes the folder's scene, of this one or of another.
    for (const bool is_same : {true, false}) {
        fs::create_directories(out);
        auto writer = std::make_unique<FileWriter>(out + "/scene.toml");
        std::thread other([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(300));
            const std::string text =
                effective + (is_same ? "" : "[[body]]\nshape = \"hypersphere\"\n");
            writer->write(text.data(), text.size());
            writer->finish();
        });
        const Outcome part = tesserae(part_words(scene, out, 2, 2, {}));
        other.join();
        EXPECT_EQ(part.status, is_same ? 0 : 2) << part.err;
        EXPECT_EQ(fs::exists(out + "/frames/still.0000.2of2.tiles"), is_same);
        EXPECT_EQ(part.err.find("holds frames of another scene") != std::string::npos, !is_same);
        EXPECT_EQ(content(out + "/scene.toml").size() == effective.size(), is_same);
        fs::remove_all(out);
    }
}

TEST(Parts, ThatAreThereAreKeptAndThoseThatLackAreNamed) {
    const Folder folder("parts");
    const auto scene = folder.write("still.toml", still_scene());
    const auto out = folder.file("out");
    for (const int k : {1, 3}) ASSERT_EQ(tesserae(part_words(scene, out, k, 3, {})).status, 0);
    const std::string first = out + "/frames/still.0000.1of3.tiles";
    const auto time = fs::last_write_time(first);
    const Outcome early = tesserae({"join", out});
    EXPECT_EQ(early.status, 1);
    EXPECT_NE(early.err.find("still.0000: parts 2 of 3"), std::string::npos) << early.err;
    ASSERT_EQ(tesserae(part_words(scene, out, 1, 3, {})).status, 0);
    EXPECT_EQ(fs::last_write_time(first), time) << "kept";
    // Parts are invisible to status and hash.
    EXPECT_EQ(tesserae({"status", out}).status, 1);

    // A damaged part is an error that names it; rendering it again mends it.
    ASSERT_EQ(tesserae(part_words(scene, out, 2, 3, {})).status, 0);
    const std::string bytes = content(first);
    std::vector<std::string> damaged = {"", "no part", bytes.substr(0, bytes.size() - 3)};
    for (const std::size_t at : {std::size_t{5}, bytes.size() / 2, bytes.size() - 2}) {
        damaged.push_back(bytes);
        damaged.back()[at] ^= 0x10;
    }
    for (const std::string& other : damaged) {
        std::ofstream(first, std::ios::binary) << other;
        const Outcome join = tesserae({"join", out});
        EXPECT_EQ(join.status, 2);
        EXPECT_NE(join.err.find("1of3.tiles"), std::string::npos) << join.err;
        EXPECT_FALSE(fs::exists(out + "/frames/still.0000.exr"));
        ASSERT_EQ(tesserae(part_words(scene, out, 1, 3, {})).status, 0);
        EXPECT_EQ(content(first), bytes);
    }
    EXPECT_EQ(tesserae({"join", out}).status, 0);
    EXPECT_EQ(tesserae({"status", out}).status, 0);
    // Once the frame is there, its parts are not made again.
    ASSERT_EQ(tesserae(part_words(scene, out, 2, 3, {})).status, 0);
    EXPECT_FALSE(fs::exists(out + "/frames/still.0000.2of3.tiles"));
}

/// A frame that is thought to be long is rendered by way of parts, and those that an earlier run
/// has left are used. (It may take 2^20 samples, which makes it 22 parts; noise is never above
/// 1000.)
TEST(Parts, AreTheJournalOfALargeFrame) {
    const Folder folder("parts");
    const auto scene = folder.write("still.toml", still_scene());
    const std::vector<std::string> large = {"--set", "render.noise_target=1000", "--set",
                                            "render.max_samples=1048576"};
    const auto whole = folder.file("whole"), out = folder.file("out");
    ASSERT_EQ(tesserae(part_words(scene, whole, 1, 1, large)).status, 0);
    ASSERT_EQ(tesserae({"join", whole}).status, 0);

    for (const int k : {1, 7}) ASSERT_EQ(tesserae(part_words(scene, out, k, 22, large)).status, 0);
    // A damaged part is made again; one of another frame in its place is not replaced.
    std::vector<std::string> words = {"render", scene, "-o", out};
    words.insert(words.end(), large.begin(), large.end());
    const std::string seventh = out + "/frames/still.0000.7of22.tiles";
    const std::string bytes = content(seventh);
    const auto other = folder.file("other");
    std::vector<std::string> otherwise = large;
    otherwise.insert(otherwise.end(), {"--set", "camera.field_of_view=20"});
    ASSERT_EQ(tesserae(part_words(scene, other, 7, 22, otherwise)).status, 0);
    fs::copy_file(other + "/frames/still.0000.7of22.tiles", seventh,
                  fs::copy_options::overwrite_existing);
    EXPECT_EQ(tesserae(words).status, 2);
    EXPECT_TRUE(fs::exists(out + "/frames/still.0000.6of22.tiles")) << "kept for the next run";
    std::ofstream(seventh, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
    const Outcome render = tesserae(words);
    ASSERT_EQ(render.status, 0) << render.err;
    expect_same_frame(whole, out);
}

/// A kill amid removing the parts of a frame that is whole leaves some of them.
TEST(Parts, OfAWholeFrameAreRemoved) {
    const Folder folder("parts");
    const auto scene = folder.write("still.toml", still_scene());
    const auto out = folder.file("out"), kept = folder.file("kept");
    for (const int k : {1, 2, 3}) ASSERT_EQ(tesserae(part_words(scene, out, k, 3, {})).status, 0);
    fs::copy(out + "/frames", kept);
    ASSERT_EQ(tesserae({"join", out}).status, 0);
    const std::string image = content(out + "/frames/still.0000.exr");
    const auto leave = [&](const std::string& part) {
        fs::copy_file(kept + "/" + part, out + "/frames/" + part);
    };
    leave("still.0000.2of3.tiles"), leave("still.0000.3of3.tiles");
    const Outcome again = tesserae({"join", out});
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_FALSE(fs::exists(out + "/frames/still.0000.2of3.tiles"));
    EXPECT_FALSE(fs::exists(out + "/frames/still.0000.3of3.tiles"));
    EXPECT_EQ(content(out + "/frames/still.0000.exr"), image);
    // Parts of a frame that looks otherwise are named and stay.
    ASSERT_EQ(
        tesserae({"render", scene, "-o", out, "--overwrite", "--set", "camera.field_of_view=20"})
            .status,
        0);
    leave("still.0000.2of3.tiles");
    const Outcome other = tesserae({"join", out});
    EXPECT_EQ(other.status, 2);
    EXPECT_NE(other.err.find("2of3.tiles"), std::string::npos) << other.err;
    EXPECT_TRUE(fs::exists(out + "/frames/still.0000.2of3.tiles"));
}

TEST(Parts, NamesThatAreNoneAreTold) {
    const Folder folder("parts");
    const auto scene = folder.write("still.toml", still_scene());
    const auto out = folder.file("out");
    ASSERT_EQ(tesserae(part_words(scene, out, 1, 1, {})).status, 0);
    const std::vector<std::string> wrong = {"still.0000.1of0.tiles", "still.0000.0of2.tiles",
                                            "still.0000.3of2.tiles", "still.0000.01of2.tiles",
                                            "still.0000.1of999999.tiles"};
    for (const std::string& name : wrong) folder.write("out/frames/" + name, "");
    const Outcome join = tesserae({"join", out});
    EXPECT_EQ(join.status, 2);
    for (const std::string& name : wrong)
        EXPECT_NE(join.err.find(name), std::string::npos) << join.err;
    EXPECT_TRUE(fs::exists(out + "/frames/still.0000.exr")) << "the frame that is there is joined";
}

TEST(Parts, AWrongPartIsRefused) {
    const Folder folder("parts");
    const auto scene = folder.write("still.toml", still_scene());
    for (const char* text : {"0/3", "4/3", "1", "x/2", "1/0"}) {
        const Outcome wrong =
            tesserae({"render", scene, "-o", folder.file("out"), "--tiles", text});
        EXPECT_EQ(wrong.status, 2) << text;
        EXPECT_NE(wrong.err.find("--tiles"), std::string::npos) << wrong.err;
    }
}

}  // namespace
}  // namespace tesserae::scenes::testing
