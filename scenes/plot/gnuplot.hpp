// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace tesserae::scenes {

/// What gnuplot writes to its standard output when it is given a script. It runs as a process of
/// its own, without a shell and without the user's start-up files.
/// @throws RunError   gnuplot is not installed (names the package), or does not like the script
std::string gnuplot_output(const std::string& script);

}  // namespace tesserae::scenes
