// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/farm/estimate.hpp"
#include "scenes/farm/request.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// What submitting made.
struct FarmReport {
    std::filesystem::path scripts;      ///< DIR/submit
    std::vector<std::string> commands;  ///< one a task, in the shell's language
    FarmEstimate estimate;
    bool moves = false;
};

/// Writes DIR/submit: the scene as it is now, and the scripts that make its film on a cluster.
/// @throws InputError   the folder holds another scene's film and not `overwrite`; the scene is
///                      cropped
/// @throws RunError     a file cannot be written
FarmReport write_farm(const Scene& scene, const std::vector<int>& frames,
                      const std::filesystem::path& folder, const FarmRequest& request,
                      bool overwrite);

/// Runs DIR/submit/submit.sh, which gives the film to Slurm, and returns what it says.
/// @throws RunError   Slurm does not take it
std::string submit_farm(const std::filesystem::path& scripts);

/// What a shell command writes on standard output, and how it ends.
struct ShellOutput {
    int status = 0;
    std::string text;
};
ShellOutput shell_output(const std::string& command);

}  // namespace tesserae::scenes
