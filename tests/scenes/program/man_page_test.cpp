// SPDX-License-Identifier: Apache-2.0
// The page of man says what --help says, in roff that its readers accept.
#include "scenes/program/man_page.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "scenes/process/shell_word.hpp"
#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

/// What a command prints that reads the page.
std::string said_by(const char* command, const std::string& page) {
    const Folder folder("man");
    const std::string file = folder.write("tesserae.1", page);
    const std::string line = fmt::format("LC_ALL=C MANWIDTH=200 {} {} > {} 2>&1", command,
                                         shell_word(file), shell_word(folder.file("said")));
    EXPECT_EQ(std::system(line.c_str()), 0) << command;
    return content(folder / "said");
}

TEST(ManPage, IsWhatTheReferencePrints) {
    EXPECT_EQ(tesserae({"reference", "man"}).out, man_page(program_help()));
}

TEST(ManPage, HasEveryCommandAndOption) {
    const ProgramHelp help = program_help();
    const std::string page = man_page(help);
    EXPECT_GT(help.commands.size(), 15U);
    for (const CommandHelp& command : help.commands) {
        const auto begin = page.find(fmt::format("\n.SS \"tesserae {}\"\n", command.name));
        ASSERT_NE(begin, std::string::npos) << command.name;
        const std::string part = page.substr(begin, page.find("\n.S", begin + 1) - begin);
        for (const OptionHelp& option : command.options)
            for (std::string name : option.names) {
                for (std::size_t at = 0; (at = name.find('-', at)) != name.npos; at += 2)
                    name.insert(at, "\\");
                EXPECT_NE(part.find(name), std::string::npos) << command.name << " " << name;
            }
    }
    EXPECT_NE(page.find("\n.SH EXIT STATUS\n0 done"), std::string::npos);
}

TEST(ManPage, IsReadWithoutWarnings) {
    if (!is_installed("man")) GTEST_SKIP() << "man is not installed";
    // Groff's warnings come before the page.
    const std::string said = said_by("man --warnings -P cat -l", man_page(program_help()));
    EXPECT_EQ(said.find("warning"), std::string::npos) << said;
    EXPECT_NE(said.find("--store-every UINT"), std::string::npos) << said;
}

TEST(ManPage, IsReadByMandocToo) {
    if (!is_installed("mandoc")) GTEST_SKIP() << "mandoc is not installed";
    EXPECT_EQ(said_by("mandoc -Tlint -Werror", man_page(program_help())), "");
}

}  // namespace
}  // namespace tesserae::scenes::testing
