// SPDX-License-Identifier: Apache-2.0
// Text over previews: letters from a font, laid over pictures, the same by every way to a preview.
#include "scenes/overlay/overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/error.hpp"
#include "render/file/stamp.hpp"
#include "scenes/overlay/text.hpp"
#include "tests/error_of.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

std::uint64_t ink(const Coverage& c) {
    std::uint64_t sum = 0;
    for (const auto part : c.parts) sum += part;
    return sum;
}

TEST(OverlayText, FitsItsRoomAndGrowsWithItsSize) {
    const Font font(Overlay::kFont);
    const Coverage small = font.line("Hello, tesseract", 12, 10'000);
    const Coverage large = font.line("Hello, tesseract", 24, 10'000);
    EXPECT_GT(ink(small), 0u);
    // Twice the size is four times the ink.
    EXPECT_NEAR(static_cast<double>(ink(large)) / static_cast<double>(ink(small)), 4, 0.6);
    EXPECT_NEAR(large.width, 2 * small.width, 8);
    for (const int most : {200, 100, 37, 5, 1}) {
        const Coverage narrow = font.line("Hello, tesseract", 24, most);
        EXPECT_LE(narrow.width, std::max(most, 16)) << most;
    }
    EXPECT_EQ(font.line("a", 20, 100).parts, font.line("a", 20, 100).parts);
    EXPECT_NE(font.line("a", 20, 100).parts, font.line("b", 20, 100).parts);
}

TEST(OverlayText, TakesAnyBytes) {
    const Font font(Overlay::kFont);
    std::mt19937_64 random(1);
    for (int i = 0; i < 300; ++i) {
        std::string bytes(random() % 40, ' ');
        for (char& c : bytes) c = static_cast<char>(random());
        const Coverage line = font.line(bytes, 1 + static_cast<int>(random() % 40), 500);
        EXPECT_LE(line.width, 500);
    }
    // A character of several bytes is one; cut, it is signs of their own.
    EXPECT_EQ(font.line("\u00e9", 20, 500).width, font.line("e", 20, 500).width);
    EXPECT_EQ(font.line("\xc3", 20, 500).parts, font.line("\ufffd", 20, 500).parts);
    EXPECT_EQ(font.line("\xe2\x82", 20, 500).parts, font.line("\ufffd\ufffd", 20, 500).parts);
}

TEST(OverlayText, OfNoFontIsAnError) {
    const Folder folder("overlay");
    EXPECT_NE(tesserae::testing::error_of<InputError>([&] {
                  Font(folder.file("none.ttf"));
              }).find("none.ttf"),
              std::string::npos);
    EXPECT_NE(tesserae::testing::error_of<InputError>([&] {
                  Font(folder.write("a.ttf", "no font"));
              }).find("is no font"),
              std::string::npos);
    EXPECT_NE(tesserae::testing::error_of<InputError>([&] {
                  Font(folder.write("b.ttf", ""));
              }).find("is no font"),
              std::string::npos);
}

/// Against real numbers: what is seen is over * alpha + under * (1 - alpha).
TEST(Stamps, LieOverAPictureAsLightDoes) {
    std::mt19937_64 random(2);
    const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
    for (int round = 0; round < 2000; ++round) {
        const int channels = 3 + round % 2;
        render::Stamp stamp = {0, 0, 1, 1, {byte(), byte(), byte(), byte()}};
        std::vector<std::uint8_t> pixel(static_cast<std::size_t>(channels));
        for (auto& c : pixel) c = byte();
        const std::vector<std::uint8_t> before = pixel;
        render::lay_over({&stamp, 1}, 1, 1, channels, pixel);
        const double a = stamp.rgba[3] / 255.0, b = channels == 4 ? before[3] / 255.0 : 1;
        const double all = a + (1 - a) * b;
        if (channels == 4) {
            EXPECT_NEAR(pixel[3], 255 * all, 0.51);
        }
        for (std::size_t i = 0; i < 3 && all > 0; ++i)
            EXPECT_NEAR(pixel[i], (stamp.rgba[i] * a + before[i] * (1 - a) * b) / all, 0.51);
    }
    // What is outside is cut off.
    render::Stamp stamp = {-2, 1, 4, 4, std::vector<std::uint8_t>(64, 255)};
    std::vector<std::uint8_t> picture(3 * 3 * 3, 0);
    render::lay_over({&stamp, 1}, 3, 3, 3, picture);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
            EXPECT_EQ(picture[static_cast<std::size_t>(3 * (3 * y + x))],
                      x < 2 && y >= 1 ? 255 : 0);
}

const std::string kOverlay =
    "\n[overlay]\ntitle = \"Balls\"\ntime = true\nw = true\n[[overlay.caption]]\ntext = \"first\"\n"
    "to = 0.05\n";

TEST(OverlayProgram, ChangesPreviewsAndNoImage) {
    const Folder folder("overlay");
    const auto scene = folder.write("small.toml", small_scene(0.1));
    const auto a = folder.file("a"), b = folder.file("b");
    ASSERT_EQ(tesserae({"run", scene, "-o", a}).status, 0);
    const std::vector<std::string> with = {
        "run", scene, "-o", b, "--set", "overlay.title=\"Balls\"", "--set", "overlay.time=true"};
    const Outcome run = tesserae(with);
    ASSERT_EQ(run.status, 0) << run.err;
    const Outcome images = tesserae({"diff", a, b});
    EXPECT_EQ(images.status, 0) << images.out << images.err;
    for (const char* name : {"/preview/small.0000.png", "/preview/small.0001.png"})
        EXPECT_NE(content(a + name), content(b + name));

    // Made again from their images they have the same bytes.
    const std::string preview = b + "/preview/small.0001.png", whole = content(preview);
    fs::remove(preview);
    ASSERT_EQ(tesserae(with).status, 0);
    EXPECT_EQ(content(preview), whole);
}

TEST(OverlayProgram, OfACopiedFrameTellsItsOwnTime) {
    // All is at rest: the second frame's pixels are copies of the first's.
    const Folder folder("overlay");
    const auto scene = folder.write("still.toml",
                                    "[physics]\nduration = 0.1\ngravity = [0, 0, 0, "
                                    "0]\n[render]\nsize = [64, 48]\nsamples = 1\n"
                                    "[[body]]\nshape = \"hypersphere\"\nradius = 1\n" +
                                        kOverlay);
    const auto out = folder.file("out");
    const Outcome run = tesserae({"run", scene, "-o", out, "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.out.find("\"copied\""), std::string::npos);
    EXPECT_NE(content(out + "/preview/still.0000.png"), content(out + "/preview/still.0001.png"));
    const std::string second = content(out + "/preview/still.0001.png");
    const auto alone = folder.file("alone");
    ASSERT_EQ(tesserae({"run", scene, "-o", alone, "--frames", "1"}).status, 0);
    EXPECT_EQ(content(alone + "/preview/still.0001.png"), second);
}

TEST(OverlayProgram, OfPartsIsThatOfTheWhole) {
    const Folder folder("overlay");
    const auto scene = folder.write("still.toml", small_scene(0) + kOverlay);
    const auto whole = folder.file("whole"), parts = folder.file("parts");
    const auto render = [&](const std::string& out, const std::vector<std::string>& more) {
        std::vector<std::string> words = {"render", scene,
                                          "-o",     out,
                                          "--set",  "render.ghost_depth=2",
                                          "--set",  "render.ghosts=\"over\""};
        words.insert(words.end(), more.begin(), more.end());
        const Outcome made = tesserae(words);
        EXPECT_EQ(made.status, 0) << made.err;
    };
    render(whole, {});
    for (const char* part : {"1/3", "2/3", "3/3"}) render(parts, {"--tiles", part});
    ASSERT_EQ(tesserae({"join", parts}).status, 0);
    for (const char* file : {"/frames/still.0000.exr", "/preview/still.0000.png"})
        EXPECT_EQ(content(parts + file), content(whole + file)) << file;
}

}  // namespace
}  // namespace tesserae::scenes::testing
