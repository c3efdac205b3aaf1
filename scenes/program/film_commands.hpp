// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/program/command_line.hpp"

namespace tesserae::scenes {

/// Moves the bodies and stores a trajectory.
void simulate_command(const CommandLine& line);

/// `run`, and `render` without a trajectory of a scene that moves: simulates, then renders; `run`
/// then makes the film.
void run_command(const CommandLine& line);

/// Makes the film of a folder's previews.
void movie_command(const CommandLine& line);

}  // namespace tesserae::scenes
