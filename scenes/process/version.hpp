// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

// Which program this is: what it tells of itself with --version and in the files that it writes.
namespace tesserae::scenes {

/// The commit that a program was built from.
struct Commit {
    std::string_view id;       ///< hexadecimal; empty: the sources were in no repository of git
    bool has_changes = false;  ///< tracked files differed from the commit
};

/// Returns the version alone: "1.2.3".
std::string program_version();

/// Returns the first line of --version, without its end: the version, and those of the laws of
/// motion and of pictures. Programs that agree in it make the same results.
std::string version_line();

/// Returns what --version prints: version_line(), then the commit, the compiler with its settings,
/// and the libraries as they were when the program was built, a line each.
std::string version_text(const Commit& commit);

/// Returns what --version --json prints. A commit that is not known is null.
nlohmann::ordered_json version_json(const Commit& commit);

}  // namespace tesserae::scenes
