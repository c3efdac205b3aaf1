#include "scenes/plan.hpp"

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
