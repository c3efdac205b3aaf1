// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

// What --help says, as data: pages and completions are made of it.
namespace tesserae::scenes {

/// An option, or what stands without one (a positional).
struct OptionHelp {
    std::vector<std::string> names;  ///< "-o", "--output"; a positional has one, without dashes
    std::string value;               ///< as --help names it; empty: a flag
    std::string about;
    bool is_positional = false, is_required = false;
    int most = 1;  ///< how often it may be given; kManyTimes: any number of times

    // What `value` tells of what may be typed.
    std::vector<std::string> words;          ///< one of these, if any
    std::vector<std::string> endings;        ///< a file that ends in one of these: ".toml"
    bool is_folder = false, is_key = false;  ///< a folder; the beginning of KEY=VALUE
};
inline constexpr int kManyTimes = 1 << 20;

struct CommandHelp {
    std::string name, about;
    std::vector<OptionHelp> options;
};

struct ProgramHelp {
    std::string name, about, exit_statuses;
    std::vector<OptionHelp> options;  ///< without a command
    std::vector<CommandHelp> commands;
    std::vector<std::string>
        keys;  ///< of KEY=VALUE: those that every scene may have, "physics.gravity"
};

/// Returns all of it.
ProgramHelp program_help();

/// Returns what --help prints of every command, as Markdown.
std::string commands_page();

}  // namespace tesserae::scenes
