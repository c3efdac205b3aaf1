// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/film/film.hpp"
#include "scenes/program/command_line.hpp"

namespace tesserae::scenes {

/// Writes the job scripts of a film and, with --now, submits it.
void submit_command(const CommandLine& line);

/// What `render --tiles` says at its end.
std::string parts_text(const FilmReport& report, const std::filesystem::path& folder);

/// Makes whole frames of parts. @return the exit status: 0, or 1 where parts are missing
int join_command(const CommandLine& line);

/// Prints how far a film is. @return the exit status: 0 it is complete, 1 it is not
int status_command(const CommandLine& line);

}  // namespace tesserae::scenes
