#pragma once

#include "scenes/program/command_line.hpp"

namespace tesserae::scenes {

/// Writes the job scripts of a film and, with --now, submits it.
void submit_command(const CommandLine& line);

/// Prints how far a film is. @return the exit status: 0 it is complete, 1 it is not
int status_command(const CommandLine& line);

}  // namespace tesserae::scenes
