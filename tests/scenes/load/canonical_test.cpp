// SPDX-License-Identifier: Apache-2.0
// The canonical text of a scene, which trajectories and folders of frames hold, is read again: by
// `tesserae status`, `export` and `view`, and compared with what other runs have written.
#include <gtest/gtest.h>

#include <random>

#include "scenes/load/scene_text.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

constexpr const char* kBall = "[[body]]\nshape = \"hypersphere\"\nradius = 1\n";

void expect_itself_again(const std::string& text, const std::vector<std::string>& sets = {}) {
    const Scene scene = load_text(text, sets);
    const Scene again = load_scene_text("again.toml", scene.effective, {});
    EXPECT_EQ(again.effective, scene.effective) << text;
    EXPECT_EQ(again.hash, scene.hash);
}

/// A vector divided by its length has a length of 1 to rounding: divided again it may be another.
TEST(CanonicalText, OfTurningCamerasIsItselfAgain) {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal;
    std::string text = kBall;
    for (int i = 0; i < 300; ++i)
        text += fmt::format(
            "[[camera.key]]\ntime = {}\nup = [{}, {}, {}, {}]\nfourth = [{}, {}, {}, {}]\n", i,
            normal(random), 9 + normal(random), normal(random), normal(random), normal(random),
            normal(random), normal(random), 9 + normal(random));
    expect_itself_again(text);
}

TEST(CanonicalText, OfACropIsItselfAgain) {
    expect_itself_again(kBall, {"render.crop=[1, 2, 30, 40]"});
    EXPECT_EQ(load_text(std::string(kBall) + "[render]\ncrop = [1, 2, 30, 40]\n").hash,
              load_text(kBall, {"render.crop=[1, 2, 30, 40]"}).hash);
}

TEST(CanonicalText, OfTheGalleryIsItselfAgain) {
    const std::filesystem::path gallery = TESSERAE_SOURCE_DIR "/scenes/gallery";
    int scenes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(gallery)) {
        if (entry.path().extension() != ".toml") continue;
        expect_itself_again(read_scene_file(entry.path()));
        ++scenes;
    }
    EXPECT_GE(scenes, 10);
}

}  // namespace
}  // namespace tesserae::scenes
