// SPDX-License-Identifier: Apache-2.0
#include "scenes/view/view.hpp"

#include <gtest/gtest.h>

#include "tests/scenes/load/load_scene_text.hpp"
#include "tests/temporary_folder.hpp"

namespace tesserae::scenes {
namespace {

TEST(WriteView, SaysWhatIsMoreThanAPageHolds) {
    const tesserae::testing::TemporaryFolder folder("view");
    const Scene scene = load_text("[[body]]\nshape = \"hypersphere\"\nradius = 1\n");
    ViewOptions options;
    options.quiet = true;
    EXPECT_EQ(write_view(scene, {}, folder / "a.html", options).bodies, 1u);
    options.most_pose_bytes = 50;
    std::string said;
    try {
        write_view(scene, {}, folder / "b.html", options);
    } catch (const InputError& error) {
        said = error.what();
    }
    EXPECT_NE(said.find("--near-slice"), std::string::npos) << said;
    EXPECT_FALSE(std::filesystem::exists(folder / "b.html"));
}

}  // namespace
}  // namespace tesserae::scenes
