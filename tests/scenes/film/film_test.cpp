// SPDX-License-Identifier: Apache-2.0
#include "scenes/film/film.hpp"

#include <gtest/gtest.h>

namespace tesserae::scenes {
namespace {

TEST(InvalidSamples, AreReportedWithACommandThatRendersTheLowestAgain) {
    Scene scene;
    scene.file = "dir/drop.toml";
    render::FrameStats stats;
    EXPECT_EQ(invalid_samples_text(stats, scene, 7), "");
    stats.count_invalid({5, 9, 3}, 1);
    stats.count_invalid({5, 8, 4}, 1);
    render::FrameStats other;
    other.count_invalid({6, 0, 0}, 2);
    stats += other;
    EXPECT_EQ(
        invalid_samples_text(stats, scene, 7),
        "dir/drop.toml: frame 7: 4 samples were infinite or no number and count as black; the "
        "first is sample 4 of pixel 8,5; to render it alone: tesserae render dir/drop.toml "
        "--frames 7 --crop 8,5,9,6 -o DIR");
}

TEST(ClampedPixels, AreReportedWithACommandThatRendersTheLowestAgain) {
    Scene scene;
    scene.file = "dir/drop.toml";
    render::FrameStats stats;
    EXPECT_EQ(clamped_pixels_text(stats, scene, 7), "");
    stats.count_clamped({5, 9, 0}, 1);
    render::FrameStats other;
    other.count_clamped({5, 8, 0}, 2);
    stats += other;
    EXPECT_EQ(clamped_pixels_text(stats, scene, 7),
              "dir/drop.toml: frame 7: 3 pixels have a colour beyond 65504, the most that a half "
              "holds, and are stored as that; weaker lights mend it; the first is pixel 8,5; to "
              "render it alone: tesserae render dir/drop.toml --frames 7 --crop 8,5,9,6 -o DIR");
}

TEST(CutPaths, AreReportedFromAThousandthOnWithWhatToDo) {
    Scene scene;
    scene.file = "dir/gem.toml";
    scene.render.specular_bounces = 9;
    render::FrameStats stats, other;
    stats.view_rays = 50'000, stats.cut_paths = 50;
    EXPECT_EQ(cut_paths_text(stats, scene, 7), "");
    other.view_rays = 50'000, other.cut_paths = 150;
    stats += other;
    EXPECT_EQ(cut_paths_text(stats, scene, 7),
              "dir/gem.toml: frame 7: 0.2 % of the light paths were cut off at 9 mirrors and "
              "surfaces of glass and are black from there on; a greater render.specular_bounces "
              "follows them farther, but for what is caught in glass or between mirrors for ever");
}

}  // namespace
}  // namespace tesserae::scenes
