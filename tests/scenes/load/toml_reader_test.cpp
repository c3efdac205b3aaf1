// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/toml_reader.hpp"

#include <gtest/gtest.h>

#include "tests/scenes/load/load_scene_text.hpp"

// Texts that the TOML library does not get, or gets with care.
namespace tesserae::scenes {
namespace {

/// Without the settings in toml_declarations.hpp each of these texts breaks an assertion of
/// toml++ 3.3. The place is the character that it does not expect.
TEST(TomlLibrary, RefusesWhatItTakesForGranted) {
    const std::vector<std::pair<const char*, const char*>> texts = {
        {"[ = ]\n", "1:3"},
        {"[[.a]]\n", "1:3"},
        {"[#]\n", "1:2"},
        {"[\xd0\xb6]\n", "1:2"},
        {"a = [ }\n", "1:7"},
        {"a = [ 1, { b = [ } ]\n", "1:18"},
        {"a = [\xe2\x80\xa8]\n", "1:6"},
        {"a = 1979-05-27 1 2\n", "1:17"},
        {"[[body]]\na = [1979-05-27 1]\n", "2:18"},
    };
    for (const auto& [text, place] : texts) {
        const std::string message = error_of(text);
        EXPECT_TRUE(message.starts_with(fmt::format("test.toml:{}: not valid TOML: ", place)))
            << text << message;
        EXPECT_TRUE(message.ends_with("unexpected character")) << text << message;
    }
    for (const char* set : {"physics.seed=[ }", "physics.seed=1979-05-27 1 2"}) {
        const std::string message = error_of("[scene]", {set});
        EXPECT_TRUE(message.starts_with(fmt::format("--set {}: not valid TOML: ", set))) << message;
        EXPECT_TRUE(message.ends_with("unexpected character")) << message;
    }
}

/// Every character may follow a line's ending backslash: toml++ 3.3 looks for blanks there, and for
/// a third of the letters does so undefined (seen with the undefined-behaviour sanitizer).
TEST(TomlLibrary, KnowsLettersFromBlanks) {
    for (const char* letter : {"\u00e9", "\u0436", "\u2e5e", "\u3042", "\ufc26", "\u4e2d"}) {
        const auto scene =
            load_text(fmt::format("[[material]]\nname = \"\"\"\\\n  {}\"\"\"\n[[body]]\nshape = "
                                  "'hypersphere'\nradius = 1\nmaterial = '{}'\n",
                                  letter, letter));
        EXPECT_EQ(scene.materials.size(), 2U) << letter;
        EXPECT_TRUE(
            error_of(fmt::format("{} = 1\n", letter)).starts_with("test.toml:1:1: not valid"));
        EXPECT_TRUE(
            error_of(fmt::format("a{} = 1\n", letter)).starts_with("test.toml:1:2: not valid"));
    }
}

/// Each would overflow the parser's stack, or take it hours or the machine's memory.
TEST(BrokenScene, Bombs) {
    const auto repeated = [](const std::string& piece, int times) {
        std::string text;
        for (int i = 0; i < times; ++i) text += piece;
        return text;
    };
    const std::string dots = repeated("a.", 100'000) + "a";
    const std::string deep = "test.toml:1:", key = "a key has more than 32 dots";
    EXPECT_NE(error_of(dots + " = 1\n").find(key), std::string::npos);
    EXPECT_NE(error_of("[" + dots + "]\n").find(key), std::string::npos);
    EXPECT_NE(error_of("[[body]]\n" + dots + " = 1\n").find("test.toml:2:66: " + key),
              std::string::npos);
    EXPECT_NE(error_of("x = { " + dots + " = 1 }\n").find(key), std::string::npos);
    EXPECT_NE(error_of("x = '''\n''' # \"\n" + dots + " = 1\n").find(key), std::string::npos);
    EXPECT_NE(error_of(repeated("\"a\" . ", 1000) + "a = 1\n").find(key), std::string::npos);
    const std::string nested = "nested deeper than 32 levels";
    EXPECT_NE(error_of("x = " + repeated("[", 100'000)).find(nested), std::string::npos);
    EXPECT_NE(error_of("x = " + repeated("{a=", 100'000)).find(nested), std::string::npos);
    EXPECT_NE(error_of("x = [" + repeated("0,", 1'000'000) + "]").find("400000 values"),
              std::string::npos);
    std::string pairs;
    for (int i = 0; i < 200'000; ++i) pairs += fmt::format("a{}.b=1\na{}.c=1\n", i, i);
    EXPECT_NE(error_of(pairs).find("100000 keys"), std::string::npos);
    EXPECT_NE(error_of("[[body]]\n" + pairs).find("a body with more than"), std::string::npos);
    EXPECT_NE(error_of(repeated("[[body]]\n", 1'000'001)).find("more than 1000000 [[body]] tables"),
              std::string::npos);
    EXPECT_NE(error_of("[[joint]]\n" + pairs).find("a joint with more than 400 values"),
              std::string::npos);
    EXPECT_NE(error_of("[[joint]]\n[joint.a]\nx=[" + repeated("0,", 500)).find("a joint with"),
              std::string::npos);
    EXPECT_NE(error_of("[[joint]]\n[camera]\n" + pairs).find("100000 keys"), std::string::npos);
    EXPECT_NE(error_of(repeated("[[joint]]\n", 200'001)).find("more than 200000 [[joint]] tables"),
              std::string::npos);
    const std::string joint = "[[joint]]\nx = [" + repeated("0,", 390) + "]\n";
    EXPECT_NE(error_of(repeated(joint, 11'000)).find("joints with more than 4000000 values"),
              std::string::npos);
    for (const std::string& set : {dots + "=1", "physics.seed=" + repeated("[", 100'000)})
        EXPECT_TRUE(error_of("", {set}).starts_with("--set ")) << set.substr(0, 40);
}

/// Dots and brackets in strings, comments and numbers are no depth.
TEST(OddScene, DepthLooksAtKeysOnly) {
    const std::string dots(1000, '.'), brackets(1000, '[');
    const std::string text = "# " + dots + brackets + "\n[[material]]\nname = \"" + dots +
                             brackets + "\\\"" + dots + "\"\n[[material]]\nname = '" + dots +
                             "\\'\n" + "[[material]]\nname = \"\"\"\n" + dots + "\n" + brackets +
                             "\"\"\"\"\"\n" + "[[material]]\nname = '''" + brackets + "''''\n";
    EXPECT_EQ(load_text(text).materials.size(), 5U);
}

}  // namespace
}  // namespace tesserae::scenes
