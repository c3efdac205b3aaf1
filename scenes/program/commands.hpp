#pragma once

#include "scenes/program/command_line.hpp"

namespace tesserae::scenes {

/// Runs one command. Results go to standard output, everything else to standard error.
/// @throws InputError, RunError, Stopped
void execute(const CommandLine& line);

/// The program: parses, executes, prints errors. Returns the exit status: 0 done, 1 failed while
/// running, 2 command line or input file wrong, 130 after SIGINT, 143 after SIGTERM.
int program(int argc, const char* const* argv);

}  // namespace tesserae::scenes
