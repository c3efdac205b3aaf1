// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace tesserae::scenes {

/// What the user asks of a farm; 0 and empty: what suits the film.
struct FarmRequest {
    std::string partition, account;
    int max_running = 0;              ///< tasks at once
    int cores = 0;                    ///< of a task
    int chunk = 0;                    ///< frames of a task
    std::string kind = "slurm";       ///< "slurm" or "commands"
    std::vector<std::string> sbatch;  ///< further options of sbatch
    bool now = false;                 ///< submit, not only write
};

}  // namespace tesserae::scenes
