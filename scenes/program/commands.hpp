// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/process/version.hpp"
#include "scenes/program/command_line.hpp"

namespace tesserae::scenes {

/// Runs one command. Results go to standard output, everything else to standard error.
/// @return 0, or 1 where diff's files differ
/// @throws InputError, RunError, Stopped
int execute(const CommandLine& line);

/// The program: parses, executes, prints errors. Returns the exit status: 0 done, 1 failed while
/// running (diff: its files differ), 2 command line or input file wrong, 130 after SIGINT, 143
/// after SIGTERM.
/// @param commit   that --version names
int program(int argc, const char* const* argv, const Commit& commit);

}  // namespace tesserae::scenes
