// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/program/help.hpp"

namespace tesserae::scenes {

/// Returns the page of section 1 that `man tesserae` shows, in the man macros of roff.
std::string man_page(const ProgramHelp& help);

}  // namespace tesserae::scenes
