// SPDX-License-Identifier: Apache-2.0
// What --version says. Scripts of farms compare its first line.
#include "scenes/process/version.hpp"

#include <H5public.h>
#include <OpenEXR/OpenEXRConfig.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <png.h>
#include <tbb/version.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "core/dynamics/motion_version.hpp"
#include "render/picture_version.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

std::string source(const char* name) {
    return content(std::filesystem::path(TESSERAE_SOURCE_DIR) / name);
}

/// The only group of the first match.
std::string found(const std::string& text, const char* expression) {
    std::smatch match;
    return std::regex_search(text, match, std::regex(expression)) ? match[1].str() : "";
}

const std::string kProjects = found(source("CMakeLists.txt"), R"(project\(\w+ VERSION ([\d.]+))");

TEST(Version, IsTheSameInTheProgramAndOnPages) {
    ASSERT_FALSE(kProjects.empty());
    EXPECT_EQ(program_version(), kProjects);
    EXPECT_EQ(found(source("CITATION.cff"), R"(\nversion: ([\d.]+))"), kProjects);
    const std::string newest = found(source("CHANGELOG.md"), R"(\n## ([\d.]+))");
    EXPECT_EQ(newest + ".0", kProjects) << "the newest version of CHANGELOG.md";
}

TEST(Version, FirstLineIsWhatScriptsCompare) {
    const std::string out = tesserae({"--version"}).out;
    EXPECT_EQ(out.substr(0, out.find('\n')),
              fmt::format("tesserae {} (motion version {}, picture version {})", kProjects,
                          kMotionVersion, render::kPictureVersion));
    EXPECT_EQ(version_line(), out.substr(0, out.find('\n')));
}

TEST(Version, NamesTheCommit) {
    const auto commit = [](const Commit& of) { return found(version_text(of), "\ncommit +(.*)"); };
    EXPECT_EQ(commit({"0123456789ab", false}), "0123456789ab");
    EXPECT_EQ(commit({"0123456789ab", true}), "0123456789ab with changes");
    EXPECT_EQ(commit({}), "unknown: built from sources without their repository");
    EXPECT_TRUE(version_json({}).at("commit").is_null());
    EXPECT_EQ(version_json({"0123456789ab", true}).at("commit"), "0123456789ab");
    EXPECT_EQ(version_json({"0123456789ab", true}).at("has_changes"), true);
    EXPECT_EQ(version_json({"0123456789ab", false}).at("has_changes"), false);
}

TEST(Version, NamesLibrariesAsTheirHeadersDo) {
    const std::string text = version_text({});
    const auto json = version_json({}).at("libraries");
    const std::pair<const char*, std::string> libraries[] = {
        {"oneTBB",
         fmt::format("{}.{}.{}", TBB_VERSION_MAJOR, TBB_VERSION_MINOR, TBB_VERSION_PATCH)},
        {"HDF5", fmt::format("{}.{}.{}", H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE)},
        {"OpenEXR", OPENEXR_VERSION_STRING},
        {"libpng", PNG_LIBPNG_VER_STRING},
        {"nlohmann-json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR,
                                      NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
    };
    for (const auto& [name, version] : libraries) {
        EXPECT_NE(text.find(fmt::format("{} {}", name, version)), std::string::npos) << text;
        EXPECT_EQ(json.at(name), version);
    }
    // None of them is without a version.
    EXPECT_EQ(json.size(), 14U);
    for (const auto& library : json.items())
        EXPECT_TRUE(std::regex_match(library.value().get<std::string>(), std::regex(R"([\d.]+)")))
            << library.key();
    EXPECT_NE(text.find("\ncompiler   "), std::string::npos);
}

TEST(Version, IsAlsoToldAsJson) {
    const Outcome outcome = tesserae({"--version", "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(json.at("version"), kProjects);
    EXPECT_EQ(json.at("motion_version"), kMotionVersion);
    // Of a command it is said after the command.
    EXPECT_EQ(tesserae({"--json"}).status, 2);
    EXPECT_EQ(tesserae({"--json", "info", "x"}).status, 2);
}

}  // namespace
}  // namespace tesserae::scenes::testing
