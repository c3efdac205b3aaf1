// SPDX-License-Identifier: Apache-2.0
// All errors of a scene file are told at once, each in its place, and lead to no others.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <sstream>

#include "tests/scenes/load/load_scene_text.hpp"

namespace tesserae::scenes {
namespace {

/// A table with errors, and what is told of it: line in the table, column, a word.
struct Wrong {
    const char* text;
    struct Error {
        std::size_t line, column;
        const char* word;
    };
    std::vector<Error> errors;
};

const std::vector<Wrong>& wrong_tables() {
    static const std::vector<Wrong> kTables = {
        {"[[body]]\nshape = \"tesseract\"\nsize = [1, 1, 1, 1]\nfriction = -1\n",
         {{2, 9, "did you mean \"hyperbox\"?"}, {4, 12, "friction = -1"}}},
        {"[[body]]\nshape = \"hypersphere\"\nmass = 0\nradius = -1\n",
         {{3, 8, "mass = 0"}, {4, 10, "radius = -1"}}},
        {"[[body]]\nshape = \"hyperbox\"\nradius = 1\n", {{3, 1, "unknown key"}}},
        {"[[body]]\nshape = \"duoprism\"\npolygons = [2, 4]\nradii = [0, 1]\n",
         {{3, 13, "polygons[0] = 2"}, {4, 10, "radii[0] = 0"}}},
        {"[[body]]\nshape = \"polychoron\"\nregular = \"24cell\"\nradius = 0\n",
         {{3, 11, "did you mean \"24-cell\"?"}, {4, 10, "radius = 0"}}},
        {"[[body]]\nradius = 1\n", {{1, 1, "shape is missing"}}},
        {"[[body]]\nshape = \"spherinder\"\n",
         {{1, 1, "radius is missing"}, {1, 1, "height is missing"}}},
        {"[[lattice]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\ncount = [1, 1, 1, 0]\n"
         "spacing = 1\n",
         {{2, 9, "cannot be in a lattice"}, {4, 19, "count[3] = 0"}}},
        {"[[body]]\nshape = \"hyperplane\"\nnormal = [0, 1, 0, 0]\nmass = 1\nvelocity = [1, 0, 0, "
         "0]\n",
         {{4, 8, "never moves"}, {5, 12, "never moves"}}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nrotation = { xq = 1, zz = 2 }\n"
         "restitution = 2\n",
         {{4, 14, "xq"}, {4, 22, "zz"}, {5, 15, "restitution = 2"}}},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\nrotation = [{ xq = 1 }, 3, { zz = 2 }]\n",
         {{4, 15, "xq"}, {4, 25, "wrong type"}, {4, 30, "zz"}}},
        {"[[light]]\ntype = \"lamp\"\nposition = [0, 1, 0, 0]\nstrength = -1\n",
         {{2, 8, "expected one of"}, {4, 12, "strength = -1"}}},
        {"[[light]]\ndirection = [0, 0, 0, 0]\n", {{1, 1, "type is missing"}}},
        {"[[material]]\nkind = \"wood\"\ncolour = [1, 0, 0]\n",
         {{2, 8, "expected one of"}, {3, 1, "did you mean \"albedo\"?"}}},
        {"[[bodies]]\nshape = \"hypersphere\"\n", {{1, 3, "did you mean \"body\"?"}}},
    };
    return kTables;
}

TEST(SceneErrors, AreToldAtOnceEachInItsPlace) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<std::size_t> order(wrong_tables().size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        std::shuffle(order.begin(), order.end(), random);
        order.resize(1 + random() % order.size());
        std::string text;
        std::vector<std::string> expected;
        std::size_t line = 0;
        for (const std::size_t i : order) {
            const Wrong& table = wrong_tables()[i];
            for (const auto& error : table.errors)
                expected.push_back(
                    fmt::format("test.toml:{}:{}: ", line + error.line, error.column));
            text += table.text;
            line += static_cast<std::size_t>(std::count(
                text.end() - static_cast<std::ptrdiff_t>(std::string_view(table.text).size()),
                text.end(), '\n'));
        }
        if (expected.size() >= 20) continue;
        const SceneFile file(text);
        std::string message;
        try {
            load_scene(file.path(), {});
        } catch (const InputError& error) {
            message = error.what();
        }
        std::istringstream lines(message);
        std::size_t count = 0;
        for (std::string told; std::getline(lines, told); ++count) {
            ASSERT_LT(count, expected.size()) << "one too many: " << told << "\nfor\n" << text;
            const auto at = told.find("test.toml:");
            ASSERT_NE(at, told.npos) << told;
            EXPECT_TRUE(told.substr(at).starts_with(expected[count]))
                << told << "\nexpected " << expected[count] << "\nfor\n"
                << text;
        }
        EXPECT_EQ(count, expected.size()) << message << "\nfor\n" << text;
    }
}

TEST(SceneErrors, SayWhatIsWrong) {
    for (const Wrong& table : wrong_tables()) {
        const std::string message = error_of(table.text);
        for (const auto& error : table.errors)
            EXPECT_NE(message.find(error.word), message.npos) << message << "\nfor\n" << table.text;
    }
}

/// A body may name what a wrong table would have been.
TEST(SceneErrors, OfAMaterialAreNotToldAgainOfItsBodies) {
    const std::string body =
        "[[body]]\nshape = \"hypersphere\"\nradius = 1\nmaterial = \"brick\"\n";
    EXPECT_NE(error_of(body).find("no material is called that"), std::string::npos);
    for (const char* table :
         {"[[material]]\nnmae = \"brick\"\n", "[[materials]]\nname = \"brick\"\n",
          "[[material]]\nname = \"brick\"\nior = 0\n"}) {
        const std::string error = error_of(table + body);
        EXPECT_NE(error, "");
        EXPECT_EQ(error.find("no material"), std::string::npos) << error;
    }
    for (const char* wrong :
         {"light = [{ type = \"sky\", strength = -1 }, 5, { type = \"sun\" }]\n",
          "material = [{ name = \"a\" }, 3]\n", "body = [5, { shape = \"hypersphere\" }]\n"})
        EXPECT_NE(error_of(wrong).find("expected an array of tables"), std::string::npos)
            << error_of(wrong);
    const std::string masses = error_of(body + "mass = 1e61\n");
    EXPECT_NE(masses.find("<= 1e+60"), std::string::npos) << masses;
    EXPECT_EQ(masses.find("1e+15"), std::string::npos) << masses;
}

TEST(SceneErrors, AreTwentyAtMost) {
    std::string text;
    for (int i = 0; i < 1000; ++i) text += "[[body]]\nshape = \"hypersphere\"\nradius = -1\n";
    const std::string message = error_of(text);
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 20) << message;
    EXPECT_TRUE(message.ends_with("there may be more")) << message;
    for (int i = 0; i < 20; ++i)
        EXPECT_NE(message.find(fmt::format(":{}:10: ", 3 * i + 3)), message.npos) << message;
}

TEST(SceneErrors, OfSyntaxSayWhatIsMeant) {
    const std::vector<std::pair<const char*, const char*>> texts = {
        {"[scene]\nname = \"abc\n", "2:12: not valid TOML"},
        {"[scene]\nname = \"abc\n", "has no closing quote"},
        {"[scene]\nname = 'abc\n[camera]\n", "has no closing quote"},
        {"[[body]]\nshape = \"hypersphere\nradius = 1\n", "has no closing quote"},
        {"[scene]\nname = \"abc", "has no closing quote"},
        {"[scene]\r\nname = \"abc\r\n", "has no closing quote"},
        {"[body]\nradius = 1\n[body]\nradius = 1\n", "several [[body]]"},
        {"[light]\n[light]\n", "several [[light]]"},
        {"[physics]\nduration = 1\n[physics]\n", "one table of this name"},
        {"[camera]\nposition = (0, 1)\n", "an [array]"},
        {"[[body]]\nshape = \"hypersphere\"\nradius = 1\n[[body.key]]\ntime = 1\n",
         "only the camera moves by keys"},
    };
    for (const auto& [text, words] : texts)
        EXPECT_NE(error_of(text).find(words), std::string::npos) << error_of(text) << "\n" << text;
    // A control character inside a string is no missing quote.
    EXPECT_EQ(error_of("[scene]\nname = \"a\x01"
                       "b\"\n")
                  .find("closing quote"),
              std::string::npos);
}

}  // namespace
}  // namespace tesserae::scenes
