// SPDX-License-Identifier: Apache-2.0
// The reference of scene files is what the program reads, and the manual's page is that.
#include "scenes/load/reference.hpp"

#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>

#include "scenes/program/help.hpp"
#include "tests/content.hpp"
#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

const std::string kManual = TESSERAE_SOURCE_DIR "/scenes/manual/";

TEST(Reference, IsTheManualsPage) {
    EXPECT_EQ(reference(""), tesserae::testing::content(kManual + "scene.md"))
        << "to make the page: tesserae reference > scenes/manual/scene.md";
    EXPECT_EQ(commands_page(), tesserae::testing::content(kManual + "commands.md"))
        << "to make the page: tesserae reference commands > scenes/manual/commands.md";
}

/// The keys that a table knows, as its error of an unknown one lists them.
std::set<std::string> known_in(const std::string& scene) {
    const std::string error = error_of(scene);
    const auto at = error.find("known here:");
    std::istringstream words(at == error.npos ? "" : error.substr(at + 11));
    std::set<std::string> known;
    for (std::string word; words >> word;) known.insert(word);
    return known;
}

TEST(Reference, HasEveryKeyThatIsRead) {
    std::vector<std::pair<std::string, std::string>> tables = {
        {"scene", "[scene]\n"},
        {"physics", "[physics]\n"},
        {"material", "[[material]]\nname = \"m\"\n"},
        {"camera", "[camera]\n"},
        {"camera.key", "[[camera.key]]\ntime = 1\n"},
        {"render", "[render]\n"},
        {"light", "[[light]]\ntype = \"sun\"\ndirection = [0, 1, 0, 0]\n"},
        {"light", "[[light]]\ntype = \"sphere\"\nposition = [0, 1, 0, 0]\nradius = 1\n"},
        {"body", "[[body]]\nshape = \"hyperbox\"\nsize = [1, 1, 1, 1]\n"},
        {"body", "[[body]]\nshape = \"hypercapsule\"\nradius = 1\nheight = 1\n"},
        {"body", "[[body]]\nshape = \"hyperplane\"\nnormal = [1, 1, 1, 1]\n"},
        {"body", "[[body]]\nshape = \"polychoron\"\nregular = \"8-cell\"\nradius = 1\n"},
        {"body", "[[body]]\nshape = \"duoprism\"\npolygons = [3, 4]\nradii = [1, 1]\n"},
        {"body", "[[body]]\nshape = \"cubinder\"\nradius = 1\nsize = [1, 1]\n"},
        {"body", "[[body]]\nshape = \"spherinder\"\nradius = 1\nheight = 1\n"},
        {"lattice",
         "[[lattice]]\nshape = \"hypersphere\"\nradius = 1\ncount = [1, 1, 1, 1]\nspacing = 1\n"},
    };
    const std::string joint =
        "[[body]]\nshape = \"hypersphere\"\nradius = 1\n"
        "[[joint]]\na = \"body-0\"\n";
    for (const char* type :
         {"point", "distance", "rope", "spring", "weld", "slider", "hinge", "swivel", "general"})
        tables.emplace_back("joint", fmt::format("{}type = \"{}\"\n", joint, type));
    for (const auto& [table, text] : tables) {
        const auto known = known_in(text + "zzz = 1\n");
        EXPECT_FALSE(known.empty()) << text;
        for (const std::string& key : known) {
            if (table == "camera" && key == "key") continue;
            EXPECT_NE(reference(table + "." + key).find("| `" + key + "` | "), std::string::npos)
                << table << "." << key;
        }
    }
    EXPECT_NE(reference("polychoron").find("`vertices`"), std::string::npos);
}

/// Each default, put in, gives the same scene as no key.
TEST(Reference, TellsTheDefaults) {
    const std::regex row(R"(\| `(\w+)` \| [^|]*\| [^|]*\| `([^|`]*)` \|[^\n]*)");
    int keys = 0;
    const std::string other = "[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0, 0]\n";
    for (const auto& [table, head] : std::vector<std::pair<std::string, std::string>>{
             {"physics", "[physics]\n"},
             {"camera", "[camera]\n"},
             {"render", "[render]\n"},
             {"material", "[[material]]\nname = \"m\"\n"},
             {"light", "[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0, 0]\n"},
             {"lattice",
              "[[lattice]]\nshape = \"hypersphere\"\nradius = 1\ncount = [1, 1, 1, 1]\nspacing = "
              "1\n"},
             {"body", "[[body]]\nshape = \"hypersphere\"\nradius = 1\n"}}) {
        std::string text = reference(table);
        if (const auto part = text.find("\n### "); part != text.npos && table == "body")
            text.resize(part);
        const std::string plain = load_text(head).effective;
        for (std::sregex_iterator at(text.begin(), text.end(), row), end; at != end; ++at) {
            const std::string key = (*at)[1], value = (*at)[2];
            // A crop of the whole frame is written, a default is not.
            EXPECT_EQ(load_text(head + key + " = " + value + "\n").effective, plain)
                << table << "." << key << " = " << value;
            ++keys;
        }
    }
    EXPECT_GT(keys, 60);
}

TEST(Reference, OfATopicIsShortOrNamesTheNearest) {
    EXPECT_NE(reference("body.friction").find("| `friction` | real |"), std::string::npos);
    EXPECT_EQ(reference("body.friction"), reference("lattice.friction"));
    EXPECT_LT(reference("render.samples").size(), 400U);
    EXPECT_EQ(reference("[[body]]"), reference("body"));
    EXPECT_NE(reference("rotation").find("[[body]]"), std::string::npos);
    EXPECT_NE(reference("hyperbox.size").find("shape = \"hyperbox\""), std::string::npos);
    EXPECT_NE(reference("size").find("[render]"), std::string::npos);
    // A joint and a light are of type "point".
    EXPECT_NE(reference("point").find("[[joint]], type"), std::string::npos);
    EXPECT_NE(reference("point").find("[[light]], type"), std::string::npos);
    EXPECT_TRUE(reference("hinge").starts_with("### `type = \"hinge\"`"));
    EXPECT_NE(reference("joint.plane").find("| `plane` | "), std::string::npos);
    EXPECT_NE(reference("camera.key.time").find("`time`"), std::string::npos);
    const auto error_for = [](const char* topic) {
        try {
            reference(topic);
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(error_for("body.frction").find("did you mean \"body.friction\"?"), std::string::npos);
    EXPECT_NE(error_for("rendr").find("did you mean \"render\"?"), std::string::npos);
    EXPECT_NE(error_for("zzzzzzzz").find("tables: scene"), std::string::npos);
}

}  // namespace
}  // namespace tesserae::scenes
