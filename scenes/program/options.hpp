// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/program/command_line.hpp"

namespace CLI {
class App;
}

// The one list of commands and options. The program reads its command line by it; --help, the page
// of commands, the man page and the completions print it. What an option takes is said by the name
// of its value, which people read and completions understand:
//   FILE.toml|h5   a file of one of these kinds
//   DIR            a folder
//   {ply,vtk}      one of these words
//   KEY=VALUE      a key of scene files and its value
//   TOPIC          what `tesserae reference` knows
namespace tesserae::scenes {

/// Options of one subcommand, as typed.
struct Typed {
    std::string size, crop, integrator, intersector, tiles;
    int samples = 0;
};

/// What the program is, in a line: its name, a colon, a sentence.
inline constexpr const char* kAbout =
    "tesserae: rigid bodies in four dimensions, simulated and filmed";

/// Adds every command and option. What is typed will be in `line` and `typed`, which have to live
/// as long as `app`.
void add_commands(CLI::App& app, CommandLine& line, Typed& typed);

}  // namespace tesserae::scenes
