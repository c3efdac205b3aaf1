// SPDX-License-Identifier: Apache-2.0
// What a shell offers after "tesserae": asked of the shells themselves.
#include "scenes/program/completion.hpp"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "scenes/generate/generate.hpp"
#include "scenes/process/shell_word.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

using Words = std::set<std::string>;

/// Words after "tesserae", the last of which is being typed, and what is offered for it.
struct Offer {
    std::vector<std::string> typed;
    Words expected;
};

/// A folder with a file of every kind.
struct FilesOfEveryKind : Folder {
    FilesOfEveryKind() : Folder("completion") {
        for (const char* name :
             {"a.toml", "my scene.toml", "b.h5", "c.exr", "d.txt", "e.h5.partial"})
            write(name, "");
        std::filesystem::create_directory(*this / "films");
    }
};

const Offer kOffers[] = {
    {{"r"}, {"run", "render", "reference"}},
    {{"run", "--int"}, {"--integrator", "--intersector"}},
    {{"run", "--integrator", ""}, {"direct", "path"}},
    {{"run", "x.toml", "--intersector", "a"}, {"analytic"}},
    {{"export", "--format", ""}, {"ply", "vtk"}},
    {{"submit", "--for", ""}, {"slurm", "commands"}},
    {{"generate", "p"}, {"pile", "pyramid", "polychora"}},
    {{"reference", "completion", ""}, {"bash", "zsh", "fish"}},
    {{"reference", "comm"}, {"commands"}},
    {{"reference", "body.friction"}, {"body.friction"}},
    {{"plan", "--set", "physics.sub"}, {"physics.substeps="}},
    {{"run", "--threads", ""}, {}},
};

/// Files and folders; the slash that follows a folder is left out.
const Offer kFiles[] = {
    {{"run", ""}, {"a.toml", "my scene.toml", "films"}},
    {{"run", "a"}, {"a.toml"}},
    {{"plot", ""}, {"b.h5", "films"}},
    {{"view", ""}, {"a.toml", "my scene.toml", "b.h5", "films"}},
    {{"diff", "a.toml", ""}, {"a.toml", "my scene.toml", "b.h5", "c.exr", "films"}},
    {{"render", "--trajectory", ""}, {"b.h5", "films"}},
    {{"run", "-o", ""}, {"films"}},
    {{"status", ""}, {"films"}},
};

/// What a shell prints when it runs the text as a script in the folder.
std::string printed_by(const char* shell, const Folder& folder, const std::string& text) {
    const std::string script = folder.write("script", text);
    const std::string command =
        fmt::format("cd {} && {} {} > {} 2>&1", shell_word(folder.path().string()), shell,
                    shell_word(script), shell_word(folder.file("printed")));
    EXPECT_EQ(std::system(command.c_str()), 0) << content(folder / "printed");
    return content(folder / "printed");
}

/// A block of lines for each offer, which a line "====" ends.
std::vector<Words> blocks(const std::string& text) {
    std::vector<Words> found(1);
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (line == "====")
            found.emplace_back();
        else
            found.back().insert(line);
    found.pop_back();
    return found;
}

/// What bash offers: its completion function is called as bash does.
std::vector<Words> offered_by_bash(const std::vector<Offer>& offers) {
    const FilesOfEveryKind folder;
    std::string text = bash_completion(program_help());
    text += R"(
try() {
    COMP_WORDS=(tesserae "$@") COMP_CWORD=$#
    _tesserae tesserae "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
    [ ${#COMPREPLY[@]} = 0 ] || printf '%s\n' "${COMPREPLY[@]}"
    echo ====
}
)";
    for (const Offer& offer : offers) {
        text += "try";
        for (const std::string& word : offer.typed) text += " " + shell_word(word);
        text += "\n";
    }
    return blocks(printed_by("bash", folder, text));
}

void expect_offers(const std::vector<Words>& found, const std::vector<Offer>& offers) {
    ASSERT_EQ(found.size(), offers.size());
    for (std::size_t i = 0; i < offers.size(); ++i)
        EXPECT_EQ(found[i], offers[i].expected)
            << "tesserae " << fmt::format("{}", fmt::join(offers[i].typed, " "));
}

TEST(Completion, OfBashOffersWordsAndFilesOfTheirKinds) {
    std::vector<Offer> offers(std::begin(kOffers), std::end(kOffers));
    offers.insert(offers.end(), std::begin(kFiles), std::end(kFiles));
    // Typed with "=" they are words of their own to bash.
    offers.push_back({{"run", "--integrator", "="}, {"direct", "path"}});
    offers.push_back({{"run", "--integrator", "=", "p"}, {"path"}});
    offers.push_back({{"run", "--set", "physics.iterations", "=", "2"}, {}});
    expect_offers(offered_by_bash(offers), offers);
}

TEST(Completion, OfBashOffersAllThatHelpLists) {
    const std::string page = commands_page();
    const std::regex option(R"(\n  (-\w,)?(--[a-z-]+))");
    std::vector<Offer> offers = {{{""}, {"-h", "--help", "--version", "--json"}}};
    for (std::size_t at = 0; (at = page.find("\n## tesserae ", at)) != page.npos;) {
        const std::size_t end = std::min(page.size(), page.find("\n## ", at + 1));
        const std::string text = page.substr(at, end - at);
        const std::string command = text.substr(13, text.find('\n', 1) - 13);
        offers[0].expected.insert(command);
        Offer options = {{command, "-"}, {}};
        for (std::sregex_iterator o(text.begin(), text.end(), option), none; o != none; ++o) {
            options.expected.insert((*o)[2]);
            if ((*o)[1].matched) options.expected.insert((*o)[1].str().substr(0, 2));
        }
        EXPECT_GE(options.expected.size(), 2U) << command;
        offers.push_back(options);
        at = end;
    }
    EXPECT_GT(offers.size(), 15U);
    expect_offers(offered_by_bash(offers), offers);
}

TEST(Completion, OfFishOffersTheSame) {
    if (!is_installed("fish")) GTEST_SKIP() << "fish is not installed";
    const FilesOfEveryKind folder;
    std::vector<Offer> offers(std::begin(kOffers), std::end(kOffers));
    offers.insert(offers.end(), std::begin(kFiles), std::end(kFiles));
    std::string text = fish_completion(program_help());
    for (const Offer& offer : offers)
        text += fmt::format("complete -C 'tesserae {}' | string replace -r '\\t.*' ''\necho ====\n",
                            fmt::join(offer.typed, " "));
    std::vector<Words> found = blocks(printed_by("env HOME=/nonexistent fish", folder, text));
    for (Words& words : found) {
        Words without;
        for (std::string word : words) {
            if (word.ends_with('/')) word.pop_back();
            without.insert(word);
        }
        words = without;
    }
    expect_offers(found, offers);
}

TEST(Completion, OfZshIsAScriptOfZsh) {
    const std::string text = zsh_completion(program_help());
    // A pattern that ends in a group of one name would ask zsh of a file's kind.
    EXPECT_FALSE(std::regex_search(text, std::regex(R"(\*\(\.\w+\))")));
    for (const char* part :
         {"'run:simulate, render, preview\\: the main job'", ":(direct path)'",
          "_files -g \"*.toml\"", "_files -g \"*(.toml|.h5)\"", "_files -/", "'*--set=["})
        EXPECT_NE(text.find(part), std::string::npos) << part;
    if (!is_installed("zsh")) GTEST_SKIP() << "zsh is not installed: its script is not read by it";
    EXPECT_EQ(printed_by("zsh -n", Folder("zsh"), text), "");
}

TEST(Completion, AsksForAShell) {
    EXPECT_EQ(tesserae({"reference", "completion", "bash"}).out, bash_completion(program_help()));
    EXPECT_EQ(tesserae({"reference", "completion", "zsh"}).out, zsh_completion(program_help()));
    EXPECT_EQ(tesserae({"reference", "completion", "fish"}).out, fish_completion(program_help()));
    for (const auto& wrong :
         std::vector<std::vector<std::string>>{{"reference", "completion"},
                                               {"reference", "completion", "fihs"},
                                               {"reference", "render", "bash"}}) {
        const Outcome outcome = tesserae(wrong);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_EQ(outcome.out, "");
    }
    EXPECT_NE(tesserae({"reference", "completion", "fihs"}).err.find("did you mean \"fish\"?"),
              std::string::npos);
}

}  // namespace
}  // namespace tesserae::scenes::testing
