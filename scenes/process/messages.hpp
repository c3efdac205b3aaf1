// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <utility>

// What the program says: messages on standard error, results on standard output.
namespace tesserae::scenes {

/// `text` as it may reach a terminal: what could steer the terminal or turn the direction of
/// writing is escaped as \u009B, and a byte that is not UTF-8 as \x9B. Tabs and ends of lines stay.
/// In JSON both mean the same as before.
std::string terminal_text(std::string_view text);

/// Gives the process a standard input, output and error where it was started without: a file opened
/// later would take their numbers, and messages would be written into it. Writing to these fails.
/// Also lets a pipe whose reader has gone be an error of the call, not the end of the process.
void open_standard_streams();

/// Writes bytes to standard error as they are. Where that is not possible they are dropped: the
/// work goes on, and its exit status tells how it ended.
void write_error(std::string_view bytes) noexcept;

/// A line on standard error that begins with the program's name. Never fails.
void tell(std::string_view text) noexcept;

/// Writes text to standard output. A reader that has gone (`| head`) ends the process as it ends
/// other programs: by SIGPIPE.
/// @throws RunError   it cannot be written
void put(std::string_view text);

/// put() of a line.
template <class... Arguments>
void put_line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    put(fmt::format(format, std::forward<Arguments>(arguments)...) + "\n");
}

/// One object in one line. Texts in it that are not UTF-8 are made so.
void put_json(const nlohmann::ordered_json& json);

}  // namespace tesserae::scenes
