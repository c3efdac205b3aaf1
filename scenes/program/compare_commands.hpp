// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/program/command_line.hpp"

namespace tesserae::scenes {

/// Prints the hash of what is in each file, a line each; with --json one object at the end.
/// @throws InputError   the first that cannot be read; the lines before it are out
void hash_command(const CommandLine& line);

/// Prints where two files differ. @return the exit status: 0 they are equal, 1 they differ
int diff_command(const CommandLine& line);

}  // namespace tesserae::scenes
