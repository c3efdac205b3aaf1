// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/program/command_line.hpp"

namespace tesserae::scenes {

/// Writes the page of a scene, which is simulated first where bodies move, or of a trajectory.
void view_command(const CommandLine& line);

}  // namespace tesserae::scenes
