// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>

#include "scenes/load/load.hpp"
#include "scenes/plan/plan.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

TEST(UnusedKeys, AreNamedWithTheirPlaceAndReason) {
    const struct {
        std::string text, key, reason;
    } cases[] = {
        {"[render]\nbounces = 3\n", "2:11: [render]: bounces = 3", "integrator = \"direct\""},
        {"[render]\nspecular_bounces = 9\n", "specular_bounces = 9", "mirror or glass"},
        {"[render]\nclamp_indirect = 2.0\n", "clamp_indirect = 2", "no indirect light"},
        {"[render]\nmax_samples = 64\n", "max_samples = 64", "noise_target = 0"},
        {"[render]\nintersector = \"analytic\"\nmax_steps = 9\n", "max_steps = 9", "no steps"},
        {"[render]\nsamples = 1\nfilter = \"gaussian\"\n", "filter = \"gaussian\"", "one sample"},
        {"[physics]\n[render]\nsamples = 1\nseed = 4\n", "seed = 4", "random"},
        {"[physics]\n[render]\nsamples = 1\nlock_noise = true\n", "lock_noise = true", "random"},
        {"[render]\nframes_per_second = 12\n", "frames_per_second = 12", "one frame"},
        {"[[lattice]]\nshape = \"hypersphere\"\nradius = 1\ncount = [1, 1, 1, 1]\n"
         "spacing = [1, 1, 1, 1]\nseed = 3\n",
         "lattice 0: seed = 3", "jitter = 0"},
        {"[camera]\nfocus_distance = 3\n", "focus_distance = 3", "all is sharp"},
        {"[camera]\nshutter = 0.5\n", "shutter = 0.5", "nothing moves"},
        {"[[material]]\nname = \"m\"\nior = 1.3\n", "material 0: ior = 1.3", "not \"glass\""},
        {"[[material]]\nname = \"m\"\nkind = \"glass\"\nroughness = 0.5\n", "roughness = 0.5",
         "not \"rough\""},
        {"[[material]]\nname = \"m\"\npattern_size = 2\n", "pattern_size = 2", "no pattern"},
        {"[render]\nghosts = \"over\"\n", "ghosts = \"over\"", "ghost_depth = 0"},
        {"[[material]]\nname = \"m\"\npattern = \"w\"\nline_width = 0.1\n", "line_width = 0.1",
         "\"grid\" or \"edges\""},
        {"[[material]]\nname = \"m\"\nw_of = \"body\"\n", "w_of = \"body\"", "not \"w\""},
        {"[[material]]\nname = \"m\"\npattern = \"edges\"\npattern_size = 2\n", "pattern_size = 2",
         "as large as the body"},
        {"[overlay]\ndial = true\n", "dial = true", "turns the slice"},
        {"[overlay]\ncolor = [1, 0, 0]\n", "color = [1, 0, 0]", "shows nothing"},
        {"[[material]]\nname = \"m\"\npattern_albedo = [1, 0, 0]\n", "pattern_albedo",
         "no pattern"},
    };
    for (const auto& c : cases) {
        const Scene scene = load_text(c.text, {});
        ASSERT_EQ(scene.unused.size(), 1u) << c.text;
        EXPECT_NE(scene.unused[0].find(c.key), std::string::npos) << scene.unused[0];
        EXPECT_NE(scene.unused[0].find(c.reason), std::string::npos) << scene.unused[0];
        EXPECT_EQ(make_plan(scene, 1).warnings, scene.unused);
    }
}

TEST(UnusedKeys, AreNoneWhereTheyCount) {
    const std::string mirror =
        "[[material]]\nname = \"m\"\nkind = \"mirror\"\n[[body]]\nshape = \"hypersphere\"\n"
        "radius = 1\nmaterial = \"m\"\n[render]\nspecular_bounces = 3\n";
    const std::vector<std::string> path = {"render.integrator=\"path\""};
    EXPECT_TRUE(load_text(mirror, {}).unused.empty());
    EXPECT_TRUE(load_text(mirror, path).unused.empty());
    EXPECT_TRUE(load_text("[render]\nbounces = 3\nclamp_indirect = 2.0\n", path).unused.empty());
    EXPECT_EQ(load_text("[render]\nbounces = 3\n", {}).unused.size(), 1u);
    EXPECT_TRUE(load_text("[render]\nsamples = 2\nfilter_width = 2.0\n", {}).unused.empty());
    EXPECT_TRUE(load_text("[camera]\naperture = 0.1\nfocus_distance = 3\n", {}).unused.empty());
    EXPECT_TRUE(load_text("[physics]\n[camera]\nshutter = 0.5\n", {}).unused.empty());
    EXPECT_TRUE(
        load_text("[[material]]\nname = \"m\"\npattern = \"checker\"\npattern_size = 2\n", {})
            .unused.empty());
    // The gallery sets a good example.
    for (const auto& entry :
         std::filesystem::directory_iterator(TESSERAE_SOURCE_DIR "/scenes/gallery"))
        if (entry.path().extension() == ".toml") {
            EXPECT_EQ(load_scene(entry.path(), {}).unused, std::vector<std::string>{})
                << entry.path();
        }
}

}  // namespace
}  // namespace tesserae::scenes
