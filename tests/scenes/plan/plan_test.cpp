// SPDX-License-Identifier: Apache-2.0
#include "scenes/plan/plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

/// Two balls, one of the material "m".
const std::string kBalls = R"(
[[material]]
name = "m"
[[body]]
shape = "hypersphere"
radius = 1
material = "m"
[[body]]
shape = "hypersphere"
radius = 1
position = [3, 0, 0, 0]
)";

Decision decision_of(const std::string& text, const std::vector<std::string>& sets,
                     const std::string& part) {
    const Plan plan = make_plan(load_text(text, sets), 1);
    const auto found = std::find_if(plan.decisions.begin(), plan.decisions.end(),
                                    [&](const Decision& d) { return d.part == part; });
    return found == plan.decisions.end() ? Decision{"", false, "no such part"} : *found;
}

TEST(Plan, ShadowRaysNeedALightThatCastsThemAndTwoBodies) {
    const auto shadows = [](const std::string& text) {
        return decision_of(text, {}, "shadow rays");
    };
    EXPECT_FALSE(shadows(kBalls).needed);
    EXPECT_FALSE(shadows(kBalls + "[[light]]\ntype = \"sky\"\n").needed);
    const std::string point = "[[light]]\ntype = \"point\"\nposition = [0, 5, 0, 0]\n";
    const std::string sphere =
        "[[light]]\ntype = \"sphere\"\nposition = [0, 5, 0, 0]\nradius = 1\n";
    EXPECT_TRUE(shadows(kBalls + point).needed);
    EXPECT_EQ(shadows(kBalls + point + sphere + sphere).reason,
              "1 point light(s), 2 sphere light(s)");
    EXPECT_FALSE(shadows(point).needed);
}

TEST(Plan, LeavesOutOfAStepWhatNoBodyHas) {
    const auto needed = [](const std::string& bodies, const std::string& part) {
        const Decision d = decision_of("[physics]\n" + bodies, {}, part);
        EXPECT_NE(d.reason, "no such part") << part;
        return d.needed;
    };
    const auto body = [](const std::string& lines) { return "[[body]]\n" + lines + "\n"; };
    const std::string sphere = "shape = \"hypersphere\"\nradius = 1\n";
    const auto box = [](const std::string& size) {
        return "shape = \"hyperbox\"\nsize = " + size + "\n";
    };
    const std::string smooth = body(sphere + "friction = 0");
    EXPECT_FALSE(needed(smooth, "friction"));
    EXPECT_TRUE(needed(smooth + body(sphere + "friction = 0.1"), "friction"));
    EXPECT_FALSE(needed(smooth, "restitution"));
    EXPECT_TRUE(needed(smooth + body(sphere + "restitution = 0.1"), "restitution"));

    // The larger restitution of a pair counts, and the geometric mean of its frictions.
    const std::string wall = "shape = \"hyperplane\"\nnormal = [1, 0, 0, 0]\n";
    EXPECT_TRUE(needed(smooth + body(wall + "restitution = 0.1"), "restitution"));
    EXPECT_FALSE(needed(smooth + body(wall + "friction = 0.1"), "friction"));

    EXPECT_FALSE(needed(body(sphere) + body(sphere), "rolling friction"));
    EXPECT_TRUE(needed(body(sphere) + body(wall + "rolling_friction = 0.1"), "rolling friction"));
    EXPECT_FALSE(needed(smooth + body(wall + "rolling_friction = 0.1"), "rolling friction"));

    const std::string rotors = "rotors and angular velocities";
    EXPECT_FALSE(needed(smooth, rotors));
    EXPECT_TRUE(needed(smooth + body(sphere), rotors)) << "friction is 0.5 by default";
    EXPECT_TRUE(needed(body(sphere + "friction = 0\nangular_velocity = { xw = 1 }"), rotors));

    const std::string inertia = "gyroscopic term and 6x6 inertia";
    EXPECT_FALSE(needed(smooth + body(box("[1, 1, 1, 1]")), inertia));
    EXPECT_TRUE(needed(smooth + body(box("[1, 2, 1, 1]")), inertia));
    const std::string held = "fixed = [\"position\", \"rotation\"]\n";
    EXPECT_FALSE(needed(smooth + body(box("[1, 2, 1, 1]") + held), inertia));
    EXPECT_FALSE(needed(body(sphere) + body(box("[1, 2, 1, 1]") + held), inertia));
    EXPECT_FALSE(needed(smooth + body(box("[1, 2, 1, 1]") + held), rotors));

    // Of each island is asked anew whether its bodies fit in floats.
    const std::string tiny = body(box("[1e-10, 1e-10, 1e-10, 1e-10]"));
    EXPECT_TRUE(needed(tiny + body(sphere), "islands in colours"));
    EXPECT_FALSE(needed(tiny + tiny, "islands in colours"));

    const auto physics = [](const std::string& bodies) {
        return decision_of("[physics]\n" + bodies, {}, "physics");
    };
    EXPECT_TRUE(physics(smooth).needed);
    EXPECT_FALSE(physics(body(sphere + held)).needed);
    EXPECT_EQ(decision_of("[physics]\n" + body(sphere + held), {}, "friction").reason,
              "no such part");
}

TEST(Plan, SaysHowLightIsFollowed) {
    const std::string illumination = "global illumination",
                      mirrors = "reflected and refracted rays";
    EXPECT_FALSE(decision_of(kBalls, {}, illumination).needed);
    const Decision path =
        decision_of(kBalls, {"render.integrator=\"path\"", "render.bounces=7"}, illumination);
    EXPECT_TRUE(path.needed);
    EXPECT_NE(path.reason.find("7 bounce"), std::string::npos) << path.reason;

    EXPECT_FALSE(decision_of(kBalls, {}, mirrors).needed);
    for (const char* kind : {"mirror", "glass"}) {
        std::string text = kBalls;
        text.insert(text.find("[[body]]"), std::string("kind = \"") + kind + "\"\n");
        EXPECT_TRUE(decision_of(text, {}, mirrors).needed) << kind;
        EXPECT_FALSE(decision_of(text, {"body.body-0.visible=false"}, mirrors).needed) << kind;
    }
}

}  // namespace
}  // namespace tesserae::scenes
