// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/hash.hpp"

#include <gtest/gtest.h>

#include "scenes/load/effective.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

// What the hash of a scene depends on.
namespace tesserae::scenes {
namespace {

TEST(SceneHash, IgnoresHowTheFileIsWritten) {
    const Scene scene =
        load_text("[physics]\nseed = 3 # hi\nduration = 2\n\n[render]\nsamples = 4");
    EXPECT_EQ(scene.hash,
              load_text("# x\nrender = {samples=4}\n[physics]\nduration=2.0\n  seed=0x3\n").hash);
}

/// Every line of the canonical text matters to the hash; those of the motion part to both.
TEST(SceneHash, SeesEveryValue) {
    const Scene scene = load_text(kRich);
    const auto changed = [&](const std::string& set) { return load_text(kRich, {set}); };
    for (const char* motion : {"physics.seed=1",
                               "physics.gravity=[0,0,0,0]",
                               "physics.steps_per_second=1",
                               "physics.iterations=1",
                               "physics.substeps=2",
                               "physics.sleeping=true",
                               "physics.integrator=\"euler\"",
                               "body.floor.offset=1",
                               "body.body-1.radius=1",
                               "body.body-1.mass=1",
                               "body.body-1.position=[0,0,0,0]",
                               "body.body-1.rotation.xy=1",
                               "body.body-1.velocity=[0,0,0,0]",
                               "body.body-1.friction=1",
                               "body.body-1.rolling_friction=0.1",
                               "lattice.rain.rolling_friction=0.1",
                               "body.floor.rolling_friction=0.1",
                               "body.body-1.restitution=1",
                               "body.body-1.fixed=[]",
                               "lattice.rain.seed=1",
                               "lattice.rain.jitter=0",
                               "lattice.rain.spacing=1",
                               "lattice.rain.count=[1,1,1,1]"}) {
        EXPECT_NE(changed(motion).hash, scene.hash) << motion;
        EXPECT_NE(changed(motion).motion_hash, scene.motion_hash) << motion;
    }
    for (const char* picture :
         {"scene.name=\"b\"", "physics.duration=1", "body.floor.name=\"b\"",
          "body.floor.visible=false", "render.samples=1", "camera.field_of_view=49",
          "light.0.color=[0,0,0]", "light.3.strength=1", "light.3.position=[0,0,0,0]",
          "light.4.radius=1", "render.integrator=\"direct\"", "render.bounces=0",
          "render.exposure=0", "render.preview_size=7", "render.crop=[0,0,1,1]",
          "body.floor.material=\"dots \\\" \\\\ \\t ä\""}) {
        EXPECT_NE(changed(picture).hash, scene.hash) << picture;
        EXPECT_EQ(changed(picture).motion_hash, scene.motion_hash) << picture;
    }
}

TEST(Hashes, KnowAToleranceThatIsNotTheDefault) {
    const Scene plain = load_text(kRich);
    EXPECT_EQ(plain.effective.find("tolerance"), std::string::npos);
    EXPECT_EQ(load_text(kRich, {"physics.tolerance=1e-6"}).effective, plain.effective);
    const Scene zero = load_text(kRich, {"physics.tolerance=0"});
    EXPECT_EQ(first_motion_difference(plain.effective, zero.effective),
              "physics: nothing there, tolerance = 0 here");
    EXPECT_EQ(load_text(zero.effective).hash, zero.hash);
}

TEST(Hashes, KnowAPreviewOfAnotherSizeThanTheDefault) {
    for (const auto& [size, usual] :
         {std::pair("[640, 360]", "640"), std::pair("[4000, 360]", "1920")}) {
        const std::string text = std::string("[render]\nsize = ") + size + "\n";
        const Scene plain = load_text(text);
        EXPECT_EQ(plain.effective.find("preview_size"), std::string::npos);
        EXPECT_EQ(load_text(text, {std::string("render.preview_size=") + usual}).hash, plain.hash);
        const Scene other = load_text(text, {"render.preview_size=321"});
        EXPECT_NE(other.hash, plain.hash);
        EXPECT_EQ(other.render.preview_size, 321);
        EXPECT_EQ(load_text(other.effective).hash, other.hash);
    }
}

TEST(Hashes, OfScenesWithoutRollingFrictionAreThoseOfBeforeThereWasAny) {
    const Scene without = load_text(kRich),
                zero = load_text(kRich, {"body.body-1.rolling_friction=0"});
    EXPECT_EQ(without.effective.find("rolling_friction"), std::string::npos);
    EXPECT_EQ(zero.effective, without.effective);
    const Scene some = load_text(kRich, {"body.body-1.rolling_friction=0.25"});
    EXPECT_EQ(first_motion_difference(without.effective, some.effective),
              "body 1 \"body-1\": nothing there, rolling_friction = 0.25 here");
    EXPECT_EQ(first_difference(some.effective, without.effective),
              "body 1 \"body-1\": rolling_friction = 0.25 there, nothing here");
    EXPECT_EQ(load_text(some.effective).hash, some.hash);
}

TEST(FirstDifference, NamesKeyAndValues) {
    const auto effective = [](const std::vector<std::string>& sets) {
        return load_text(kRich, sets).effective;
    };
    const std::string base = effective({});
    EXPECT_EQ(first_difference(base, base), "");
    EXPECT_EQ(first_difference(base, effective({"render.samples=16"})),
              "render.samples: 4 there, 16 here");
    EXPECT_EQ(first_difference(base, effective({"body.body-1.friction=0.7"})),
              "body 1 \"body-1\".friction: 0.1 there, 0.7 here");
    EXPECT_EQ(first_difference(base, effective({"body.floor.name=\"f\""})),
              "body 0.name: \"floor\" there, \"f\" here");
    EXPECT_EQ(first_difference(base, effective({"render.crop=[0, 0, 1, 1]"})),
              "render: nothing there, crop = [0, 0, 1, 1] here");

    // What does not decide motion is passed over, but still names the body.
    const auto motion = [&](const std::vector<std::string>& sets) {
        return first_motion_difference(base, effective(sets));
    };
    const std::string shown = "scene.name=\"b\"", longer = "physics.duration=9";
    EXPECT_EQ(motion({shown, longer, "render.samples=16"}), "");
    EXPECT_EQ(motion({shown, longer, "physics.seed=9"}),
              "physics.seed: 9223372036854775807 there, 9 here");
    EXPECT_EQ(motion({shown, longer, "body.floor.visible=false", "body.body-1.friction=0.7"}),
              "body 1 \"body-1\".friction: 0.1 there, 0.7 here");
}

}  // namespace
}  // namespace tesserae::scenes
