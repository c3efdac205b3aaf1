// SPDX-License-Identifier: Apache-2.0
// Links in the READMEs and other pages lead where they say: files exist, and a function named in a
// link is in the file.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <vector>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = TESSERAE_SOURCE_DIR;

/// The READMEs and whatever else is written for readers.
std::vector<fs::path> pages() {
    std::vector<fs::path> found = {kSource / "README.md", kSource / "CONTRIBUTING.md",
                                   kSource / "CHANGELOG.md"};
    for (const char* room : {"core", "parallel", "render", "scenes", "bench", "tests"})
        for (const auto& entry : fs::recursive_directory_iterator(kSource / room))
            if (entry.path().extension() == ".md") found.push_back(entry.path());
    return found;
}

/// A page without its blocks of code, in which brackets are no links.
std::string prose(const fs::path& page) {
    std::istringstream lines(content(page));
    std::string text;
    bool is_code = false;
    for (std::string line; std::getline(lines, line);) {
        const bool is_fence = line.find_first_not_of(' ') == line.find("```") &&
                              line.find("```") != std::string::npos;
        if (is_fence) is_code = !is_code;
        if (!is_code && !is_fence) text += line + "\n";
    }
    return text;
}

TEST(Readme, LinksLeadToFilesThatHoldWhatTheyName) {
    // [label](path), [label](path#section), and [label]: path on a line of its own.
    const std::regex link(R"(\[([^\]]*)\](?:\(([^)#]+)(?:#[^)]*)?\)|: ([^\s#]+)(?:#\S*)?\n))");
    const std::regex name(R"(`(?:\w+::)?(\w+)`)");
    int links = 0, names = 0;
    for (const fs::path& readme : pages()) {
        const std::string text = prose(readme);
        for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at) {
            const std::string label = (*at)[1], target = (*at)[(*at)[2].matched ? 2 : 3];
            if (target.starts_with("http")) continue;
            ++links;
            const fs::path file = readme.parent_path() / target;
            ASSERT_TRUE(fs::exists(file)) << readme << " links to " << target;
            for (std::sregex_iterator n(label.begin(), label.end(), name); n != end; ++n) {
                ++names;
                EXPECT_NE(content(file).find((*n)[1]), std::string::npos)
                    << readme << ": " << target << " has no " << (*n)[1];
            }
        }
    }
    EXPECT_GT(links, 100);
    EXPECT_GT(names, 50);
}

TEST(Readme, IsOnePage) {
    const std::string text = content(kSource / "README.md");
    EXPECT_LE(text.size(), 10'000U);
    EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 130);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 160U) << line;
    // What the project was like before is told by its commits.
    EXPECT_FALSE(std::regex_search(text, std::regex(R"([Vv]ersion \d)")));
}

TEST(Readme, ItsSceneRuns) {
    const std::string text = content(kSource / "README.md");
    const std::string fence = "```toml fall.toml\n";
    const std::size_t begin = text.find(fence) + fence.size(), end = text.find("```", begin);
    ASSERT_LT(end, text.size());
    const Folder folder("readme");
    const auto scene = folder.write("fall.toml", text.substr(begin, end - begin));
    // All of its three seconds are run by tests/manual/typed.py.
    const Outcome run =
        tesserae({"run", scene, "-o", folder.file("out"), "--size", "64x36", "--samples", "1",
                  "--set", "physics.duration=1", "--frames", "0,29"});
    EXPECT_EQ(run.status, 0) << run.err;
}

/// tests/README.md says of every source that has no test file of its name where it is tested, and
/// of no other.
TEST(Readme, SaysWhereEverySourceIsTested) {
    const std::string page = content(kSource / "tests" / "README.md");
    const std::regex row(R"(\| ([a-z/]+): ([a-z0-9_, ]+) \|)"), word(R"([a-z0-9_]+)");
    std::vector<std::string> told, lacking;
    for (std::sregex_iterator at(page.begin(), page.end(), row), end; at != end; ++at) {
        const std::string folder = (*at)[1], names = (*at)[2];
        for (std::sregex_iterator n(names.begin(), names.end(), word); n != end; ++n)
            told.push_back(folder + "/" + n->str());
    }
    for (const char* room : {"core", "parallel", "render", "scenes"})
        for (const auto& entry : fs::recursive_directory_iterator(kSource / room)) {
            fs::path source = fs::relative(entry.path(), kSource);
            if (source.extension() != ".cpp") continue;
            source.replace_extension();
            if (!fs::exists(kSource / "tests" / (source.string() + "_test.cpp")))
                lacking.push_back(source.string());
        }
    std::sort(told.begin(), told.end());
    std::sort(lacking.begin(), lacking.end());
    EXPECT_EQ(told, lacking);
}

}  // namespace
}  // namespace tesserae::scenes::testing
