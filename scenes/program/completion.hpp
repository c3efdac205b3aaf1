// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/program/help.hpp"

// Scripts by which a shell completes what is typed after "tesserae": commands, options, files of
// the kinds that are read, words where these are known.
namespace tesserae::scenes {

std::string bash_completion(const ProgramHelp& help);
std::string zsh_completion(const ProgramHelp& help);
std::string fish_completion(const ProgramHelp& help);

}  // namespace tesserae::scenes
