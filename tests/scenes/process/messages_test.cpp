// SPDX-License-Identifier: Apache-2.0
// What is said never steers a terminal, and never ends the work.
#include "scenes/process/messages.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "tests/scenes/program/program.hpp"

namespace tesserae::scenes::testing {
namespace {

TEST(TerminalText, EscapesWhatSteersATerminal) {
    EXPECT_EQ(terminal_text("plain, t\tab\nline \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80"),
              "plain, t\tab\nline \xc3\xa9 \xe2\x82\xac \xf0\x9f\x98\x80");
    EXPECT_EQ(terminal_text("\x1b[31m\r\x7f"), "\\u001B[31m\\u000D\\u007F");
    EXPECT_EQ(terminal_text("\xc2\x9b\xc2\x80"), "\\u009B\\u0080") << "C1: control sequences";
    EXPECT_EQ(terminal_text("\xe2\x80\xae\xe2\x81\xa6\xd8\x9c"), "\\u202E\\u2066\\u061C");
    EXPECT_EQ(terminal_text("\xe2\x80\xa8"), "\\u2028");
}

/// Text that is not UTF-8 has its bytes escaped one by one.
TEST(TerminalText, EscapesBytesThatAreNoCharacters) {
    EXPECT_EQ(terminal_text("\x9b\xff"), "\\x9B\\xFF");
    EXPECT_EQ(terminal_text("\xc0\x9b"), "\\xC0\\x9B") << "too long a form of a control";
    EXPECT_EQ(terminal_text("\xe2\x80"), "\\xE2\\x80") << "cut off";
    EXPECT_EQ(terminal_text("\xed\xa0\x80"), "\\xED\\xA0\\x80") << "a surrogate";
    EXPECT_EQ(terminal_text("\xf4\x90\x80\x80"), "\\xF4\\x90\\x80\\x80") << "beyond U+10FFFF";
}

/// Every code point by itself: only those of the controls' blocks change.
TEST(TerminalText, LeavesAllOtherCharacters) {
    std::size_t escaped = 0;
    for (std::uint32_t c = 0; c <= 0x10ffff; ++c) {
        if (c >= 0xd800 && c < 0xe000) continue;
        std::string text;
        if (c < 0x80) {
            text = {static_cast<char>(c)};
        } else if (c < 0x800) {
            text = {static_cast<char>(0xc0 | c >> 6), static_cast<char>(0x80 | (c & 0x3f))};
        } else if (c < 0x10000) {
            text = {static_cast<char>(0xe0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 0x3f)),
                    static_cast<char>(0x80 | (c & 0x3f))};
        } else {
            text = {static_cast<char>(0xf0 | c >> 18), static_cast<char>(0x80 | (c >> 12 & 0x3f)),
                    static_cast<char>(0x80 | (c >> 6 & 0x3f)),
                    static_cast<char>(0x80 | (c & 0x3f))};
        }
        escaped += terminal_text(text) != text;
    }
    // 30 of C0, DEL, 32 of C1, 3 marks, 7 from U+2028 to U+202E, 4 isolates.
    EXPECT_EQ(escaped, 30u + 1 + 32 + 3 + 7 + 4);
}

/// Exit status of the program when its streams were first changed.
int status_with(const std::function<void()>& change, const std::vector<std::string>& arguments) {
    const pid_t child = ::fork();
    if (child == 0) {
        change();
        std::vector<const char*> words = {TESSERAE_PROGRAM};
        for (const std::string& argument : arguments) words.push_back(argument.c_str());
        words.push_back(nullptr);
        ::execv(TESSERAE_PROGRAM, const_cast<char* const*>(words.data()));
        ::_exit(127);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

void to_full_disk(int stream) { ::dup2(::open("/dev/full", O_WRONLY), stream); }
void to_nowhere(int stream) { ::dup2(::open("/dev/null", O_WRONLY), stream); }

/// Without its reader.
void to_broken_pipe(int stream) {
    int ends[2];
    if (::pipe(ends) != 0) ::_exit(126);
    ::close(ends[0]);
    ::dup2(ends[1], stream);
}

TEST(Messages, ThatCannotBeWrittenAreDropped) {
    const Folder folder("messages");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const std::function<void()> ways[] = {[] { to_full_disk(STDERR_FILENO); },
                                          [] { ::close(STDERR_FILENO); },
                                          [] { to_broken_pipe(STDERR_FILENO); }};
    int number = 0;
    for (const auto& way : ways) {
        const auto quiet = [&] {
            to_nowhere(STDOUT_FILENO);
            way();
        };
        const std::string out = folder.file("out" + std::to_string(number++));
        EXPECT_EQ(status_with(quiet, {"run", scene, "-o", out, "--size", "32x18", "--samples", "1",
                                      "--threads", "1"}),
                  0);
        EXPECT_EQ(tesserae({"status", out}).status, 0);
        EXPECT_EQ(content(out + "/trajectory.h5").find("tesserae: "), std::string::npos)
            << "no message is written into a file that has the stream's number";
        EXPECT_EQ(status_with(quiet, {"info", folder.file("none.toml")}), 2);
    }
}

TEST(Messages, ResultsThatCannotBeWrittenAreAFailure) {
    const Folder folder("messages");
    const auto scene = folder.write("drop.toml", small_scene(0.1));
    const auto status = [&](const std::function<void()>& way) {
        return status_with(
            [&] {
                to_nowhere(STDERR_FILENO);
                way();
            },
            {"info", scene});
    };
    EXPECT_EQ(status([] { to_nowhere(STDOUT_FILENO); }), 0);
    EXPECT_EQ(status([] { to_full_disk(STDOUT_FILENO); }), 1);
    EXPECT_EQ(status([] { ::close(STDOUT_FILENO); }), 1);
    EXPECT_EQ(status([] { ::close(STDOUT_FILENO), ::close(STDERR_FILENO); }), 1);
    EXPECT_EQ(status([] { to_broken_pipe(STDOUT_FILENO); }), 1000 + SIGPIPE) << "as `| head` does";
}

/// Names of a scene reach a terminal by info, plan and run, in text and in JSON.
TEST(Messages, NamesDoNotSteerTheTerminal) {
    const Folder folder("messages");
    const auto scene = folder.write("drop.toml",
                                    "[render]\nsize = [32, 18]\nsamples = 1\n[[body]]\n"
                                    "name = \"a\xc2\x9b\x35m\xe2\x80\xae\"\n"
                                    "shape = \"polychoron\"\nregular = \"5-cell\"\nradius = 1\n");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"info", scene},
          {"info", scene, "--json"},
          {"plan", scene},
          {"plan", scene, "--json"},
          {"run", scene, "-o", folder.file("out")},
          {"render", scene, "--set", "body.\"a\xc2\x9b\".mass=1", "-o", folder.file("out")}}) {
        const Outcome said = tesserae(words);
        const std::string all = said.out + said.err;
        EXPECT_EQ(all.find("\xc2\x9b"), std::string::npos) << words[0];
        EXPECT_EQ(all.find("\xe2\x80\xae"), std::string::npos) << words[0];
        EXPECT_NE(all.find("\\u009B"), std::string::npos) << words[0] << ": " << all;
    }
    const auto json = nlohmann::json::parse(tesserae({"info", scene, "--json"}).out);
    EXPECT_EQ(json["hulls"][0]["body"], "a\xc2\x9b\x35m\xe2\x80\xae") << "JSON means the same";
}

}  // namespace
}  // namespace tesserae::scenes::testing
