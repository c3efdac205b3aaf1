// SPDX-License-Identifier: Apache-2.0
// What the keys of materials, lights and frames mean.
#include <gtest/gtest.h>

#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

TEST(LoadPicture, GlassIsClearWhereNothingElseIsSaid) {
    const auto albedo = [](const char* keys) {
        return load_text(std::string("[[material]]\nname = \"m\"\n") + keys).materials[1].albedo;
    };
    EXPECT_TRUE((albedo("kind = \"glass\"\n") == 1).all());
    EXPECT_TRUE((albedo("kind = \"mirror\"\n") == 0.8).all());
    EXPECT_TRUE((albedo("albedo = [0.5, 0.5, 0.5]\nkind = \"glass\"\n") == 0.5).all());
}

}  // namespace
}  // namespace tesserae::scenes
