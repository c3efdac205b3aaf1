// SPDX-License-Identifier: Apache-2.0
// How large previews and the film are, in everything that makes or looks at them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/render/png_picture.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;
using render::Png;
using Words = std::vector<std::string>;

class PreviewSizes : public ::testing::Test {
  protected:
    Outcome run(const std::string& command, const std::string& to, const Words& more = {}) const {
        Words words = {command, scene_, "-o", folder_.file(to)};
        words.insert(words.end(), more.begin(), more.end());
        return tesserae(words);
    }
    std::string preview(const std::string& in, int frame) const {
        return folder_.file(fmt::format("{}/preview/drop.{:04}.png", in, frame));
    }

    const Folder folder_{"preview"};
    /// Two frames of 101x57, whose previews are 40x22.
    const std::string scene_ = folder_.write("drop.toml", [] {
        std::string text = small_scene(0.1);
        text.replace(text.find("[64, 48]"), 8, "[101, 57]\npreview_size = 40");
        return text;
    }());
};

void expect_size(const std::string& file, std::uint32_t width, std::uint32_t height) {
    const Png png(file);
    EXPECT_EQ(png.width, width) << file;
    EXPECT_EQ(png.height, height) << file;
}

TEST_F(PreviewSizes, AreThoseOfTheKeyByEveryWay) {
    ASSERT_EQ(run("run", "film").status, 0);
    for (const int frame : {0, 1}) expect_size(preview("film", frame), 40, 22);
    for (const int k : {1, 2, 3})
        ASSERT_EQ(run("render", "parts", {"--tiles", fmt::format("{}/3", k)}).status, 0);
    ASSERT_EQ(tesserae({"join", folder_.file("parts")}).status, 0);
    for (const int frame : {0, 1})
        EXPECT_EQ(content(preview("parts", frame)), content(preview("film", frame)));
    ASSERT_EQ(run("run", "film", {"--draft"}).status, 0);
    expect_size(preview("film/draft", 0), 14, 8);
    // The images know nothing of it.
    ASSERT_EQ(run("render", "full", {"--set", "render.preview_size=101"}).status, 0);
    expect_size(preview("full", 0), 101, 57);
    EXPECT_EQ(tesserae({"diff", folder_.file("film"), folder_.file("full")}).status, 0);
    const Outcome narrower = run("render", "narrow", {"--size", "30x20"});
    EXPECT_EQ(narrower.status, 2);
    EXPECT_NE(narrower.err.find("preview_size = 40"), std::string::npos) << narrower.err;
}

TEST_F(PreviewSizes, OfOthersAreMadeAgain) {
    ASSERT_EQ(run("render", "film").status, 0);
    ASSERT_EQ(run("render", "full", {"--set", "render.preview_size=101"}).status, 0);
    const std::string whole = content(preview("film", 1));
    fs::copy_file(preview("full", 1), preview("film", 1), fs::copy_options::overwrite_existing);
    const Outcome status = tesserae({"status", folder_.file("film"), "--json"});
    EXPECT_EQ(status.status, 1);
    EXPECT_EQ(nlohmann::json::parse(status.out)["missing"].dump(), "[1]") << status.out;
    const Outcome again = run("render", "film");
    ASSERT_EQ(again.status, 0) << again.err;
    EXPECT_NE(again.err.find("has 101x57 pixels, not 40x22: made again from its image"),
              std::string::npos)
        << again.err;
    EXPECT_EQ(content(preview("film", 1)), whole);
}

TEST_F(PreviewSizes, ArePlannedFor) {
    const auto plan = [&](const char* size, const char* preview) {
        const Words words = {"plan",
                             scene_,
                             "--json",
                             "--set",
                             fmt::format("render.size={}", size),
                             "--set",
                             fmt::format("render.preview_size={}", preview)};
        return nlohmann::json::parse(tesserae(words).out);
    };
    const auto decision = [](const nlohmann::json& told) {
        for (const auto& d : told["decisions"])
            if (d["part"] == "smaller previews") return d;
        return nlohmann::json();
    };
    const auto full = plan("[600, 400]", "600"), half = plan("[600, 400]", "300");
    EXPECT_EQ(decision(full)["needed"], false);
    EXPECT_EQ(decision(half)["needed"], true);
    EXPECT_NE(decision(half)["reason"].get<std::string>().find("300x200"), std::string::npos);
    // 36 bytes a pixel.
    EXPECT_EQ(full["memory_bytes"].get<int>() - half["memory_bytes"].get<int>(),
              36 * (600 * 400 - 300 * 200) -
                  static_cast<int>(std::string("preview_size = 300\n").size()));
}

}  // namespace
}  // namespace tesserae::scenes::testing
