// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/overrides.hpp"

#include <gtest/gtest.h>

#include "tests/scenes/load/load_scene_text.hpp"

// What --set changes in a scene.
namespace tesserae::scenes {
namespace {

TEST(Overrides, ReachEveryTable) {
    const auto with = [](const std::vector<std::string>& sets) { return load_text(kRich, sets); };
    EXPECT_EQ(with({"physics.iterations=20"}).physics->iterations, 20);
    EXPECT_EQ(with({"physics.iterations = 20 # more", "physics.iterations=30"}).physics->iterations,
              30);
    EXPECT_EQ(with({"body.body-1.mass=2"}).bodies.type_of(1).mass, 2);  // instead of its density
    EXPECT_EQ(with({"body.body-1.position=[9, 8, 7, 6]"}).bodies.position[1], Vec4(9, 8, 7, 6));
    EXPECT_EQ(with({"body.body-1.angular_velocity.yz=1"}).bodies.angular_velocity[1],
              (Bivector{0, 0, 2, 1, 0, 0}));
    EXPECT_EQ(with({"lattice.rain.count=[1, 1, 1, 1]"}).bodies.size(), 3U);
    EXPECT_EQ(with({"material.\"dots \\\" \\\\ \\t ä\".albedo=[0, 0, 0]"}).materials[1].albedo[2],
              0);
    EXPECT_EQ(with({"light.0.strength=5"}).lights.suns[0].irradiance[0], 5);
    EXPECT_EQ(with({"camera.position=[0, 0, -1, 0]"}).camera.position, Vec4(0, 0, -1, 0));
    EXPECT_EQ(with({"render.size=[8, 9]"}).render.height, 9);
    EXPECT_EQ(with({"scene.name=\"other\""}).name, "other");
    const Scene cropped = with({"render.crop=[1, 2, 3, 4]"});
    ASSERT_TRUE(cropped.render.crop);
    EXPECT_EQ(cropped.render.crop->y1, 4);
    EXPECT_TRUE(cropped.effective.ends_with("\ncrop = [1, 2, 3, 4]\n"));
    // Tables that the file does not have, and bodies as inline tables.
    EXPECT_EQ(load_text("[scene]", {"physics.seed=3"}).physics->seed, 3U);
    EXPECT_EQ(load_text("body = [{shape = 'hypersphere', radius = 1}]", {"body.body-0.mass=2"})
                  .bodies.types[0]
                  .mass,
              2);
    EXPECT_EQ(with({"physics.seed=4"}).hash, load_text(with({"physics.seed=4"}).effective).hash);
}

TEST(Overrides, ErrorsNameTheEntry) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"physics.iterations=0", "[physics]: iterations = 0: expected an integer from 1 to 10000"},
        {"physics.itertions=1", "did you mean \"iterations\"?"},
        {"phsyics.seed=1", "no table is called \"phsyics\"; did you mean \"physics\"?"},
        {"physics=1", "expected physics.KEY=VALUE"},
        {"body.floor=1", "expected body.NAME.KEY=VALUE"},
        {"body.flor.friction=1", "no body is called \"flor\"; did you mean \"floor\"?"},
        {"lattice.rian.jitter=1", "no lattice is called \"rian\"; did you mean \"rain\"?"},
        {"light.9.strength=1", "no light is called \"9\""},
        {"body.floor.position=[0, 0, 0, 0]", "never moves"},
        {"lattice.rain.size=[1, 1, 1]", "has 3 values"},
        {"render.intersector=analytic", "a string needs quotes"},
        {"render.samples", "expected KEY=VALUE"},
        {"", "expected KEY=VALUE"},
        {"[physics]", "expected KEY=VALUE"},
        {"render.samples=1\nrender.tile=8", "control character"},
        {"physics.gravity.x=1", "\"gravity\" is no table"},
        {"render.integrator=\"pathe\"", "did you mean \"path\"?"},
        {"render.crop=[0, 0, 641, 10]", "x1 <= 640"},
        {"render.crop=[5, 0, 5, 10]", "x0 < x1"},
        {"render.crop=[-1, 0, 5, 10]", "crop[0] = -1"},
    };
    for (const auto& [set, words] : cases) {
        const std::string message = error_of(kRich, {set});
        EXPECT_TRUE(message.starts_with("--set " + printable(set) + ": "))
            << set << " gave " << message;
        EXPECT_NE(message.find(words), std::string::npos) << set << " gave " << message;
    }
}

}  // namespace
}  // namespace tesserae::scenes
