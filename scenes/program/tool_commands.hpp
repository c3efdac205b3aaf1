// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/program/command_line.hpp"

namespace tesserae::scenes {

/// `tesserae plot`.
void plot_command(const CommandLine& line);

/// `tesserae export`.
void export_command(const CommandLine& line);

}  // namespace tesserae::scenes
