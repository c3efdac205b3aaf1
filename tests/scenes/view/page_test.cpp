// SPDX-License-Identifier: Apache-2.0
// The page is one file that needs nothing else, and what a scene says stays text in it.
#include "scenes/view/page.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scenes/process/base64.hpp"
#include "scenes/view/page_scene.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

std::string scene_json(const std::string& text) {
    const Scene scene = load_text(text);
    return page_scene(scene, {{0, scene.camera}}, {});
}

/// RFC 4648, section 10.
TEST(Base64, IsThatOfTheStandard) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfb"), "//77");
}

TEST(Page, NamesNoOtherFile) {
    const std::string hash(32, 'a'), page = page_text(hash, "{}", "poses", true);
    for (const char* word : {" src=", "http:", "https:", "import ", "@import", "url(", "fetch("})
        EXPECT_EQ(page.find(word), std::string::npos) << word;
    EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
    EXPECT_NE(page.find(base64("poses")), std::string::npos);
    EXPECT_EQ(page_hash(page.substr(0, 2000)), hash);
    EXPECT_EQ(page_hash("<html>"), "");
    // Everything that index.html names is in it.
    for (const PageSource& source : page_sources()) {
        if (source.name == "index.html") continue;
        EXPECT_NE(page.find(source.text), std::string::npos) << source.name;
    }
}

TEST(Page, WithoutJointsHasNothingOfThem) {
    const std::string hash(32, 'a'), page = page_text(hash, "{}", "poses", false);
    EXPECT_EQ(page.find("class JointLines"), std::string::npos);
    EXPECT_EQ(page.find("id=\"joints\""), std::string::npos);
    const std::string joints = page_text(hash, "{}", "poses", true);
    EXPECT_NE(joints.find("class JointLines"), std::string::npos);
    EXPECT_NE(joints.find("id=\"joints\""), std::string::npos);
}

/// Text that ends its own script would end the page's.
TEST(Page, NoSourceEndsItsOwnTag) {
    for (const PageSource& source : page_sources()) {
        if (source.name == "index.html") continue;
        for (const char* end : {"</script", "<!--"})
            EXPECT_EQ(source.text.find(end), std::string::npos) << source.name;
    }
}

TEST(PageScene, HostileNamesAreText) {
    const std::string name = "</script><script>alert(1)</script><!-- \u2028 \" ' \\ & é";
    const std::string json =
        scene_json("[[body]]\nshape = \"hypersphere\"\nradius = 1\nname = '''" + name + "'''\n");
    EXPECT_EQ(json.find('<'), std::string::npos);
    for (const char c : json) EXPECT_TRUE(c >= ' ' && c <= '~') << static_cast<int>(c);
    EXPECT_EQ(nlohmann::json::parse(json)["names"][0][0], name);
}

TEST(PageScene, SaysWhatEveryShapeIs) {
    const auto json = nlohmann::json::parse(scene_json(R"(
[[body]]
shape = "hyperbox"
size = [1, 2, 3, 4]
[[body]]
shape = "polychoron"
regular = "24-cell"
radius = 1
[[body]]
shape = "polychoron"
regular = "24-cell"
radius = 1
density = 2
[[body]]
shape = "duocylinder"
radii = [1, 2]
[[body]]
shape = "hyperplane"
normal = [0, 2, 0, 0]
offset = 3
)"));
    ASSERT_EQ(json["types"].size(), 5u);
    EXPECT_EQ(json["types"][0]["half"], (nlohmann::json{0.5, 1.0, 1.5, 2.0}));
    // Equal hulls are there once.
    EXPECT_EQ(json["types"][1]["hull"], 0);
    EXPECT_EQ(json["types"][2]["hull"], 0);
    ASSERT_EQ(json["hulls"].size(), 1u);
    EXPECT_EQ(json["hulls"][0]["planes"].size(), 24u);
    EXPECT_EQ(json["types"][3]["axes"][1], (nlohmann::json{0.0, 0.0, 1.0, 1.0}));
    EXPECT_EQ(json["types"][4]["normal"], (nlohmann::json{0.0, 1.0, 0.0, 0.0}));
    EXPECT_EQ(json["types"][4]["offset"], 3.0);
}

}  // namespace
}  // namespace tesserae::scenes
