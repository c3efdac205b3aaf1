// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/farm/estimate.hpp"
#include "scenes/farm/request.hpp"

namespace tesserae::scenes {

/// What the scripts of a film are made of. They hold no date and no machine's name, and but for the
/// program's no path: they find their folder, so that it may be moved.
struct FarmFilm {
    std::string name;                ///< of the scene
    std::filesystem::path program;   ///< as the nodes see it
    bool moves = false;              ///< there is something to simulate
    std::vector<std::string> tasks;  ///< frames of each
    FarmEstimate estimate;
    FarmRequest request;
};

/// A file of DIR/submit.
struct FarmScript {
    std::string name, text;
};
/// film.sh (what all share), simulate.sh, frames.sh, finish.sh, submit.sh, tasks.txt.
std::vector<FarmScript> farm_scripts(const FarmFilm& film);

}  // namespace tesserae::scenes
