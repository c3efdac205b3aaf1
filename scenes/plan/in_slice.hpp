// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// When bodies of one name are in the picture.
struct InPicture {
    std::string name;
    std::uint64_t bodies = 0;                      ///< of the name
    std::uint64_t most_bodies = 0;                 ///< in one frame
    double largest = 0;                            ///< one's part of the picture's height, <= 1
    std::vector<std::pair<double, double>> times;  ///< from the first to the last frame [s]
};

/// What the frames of a film show of its bounded bodies.
struct SliceReport {
    std::vector<InPicture> names;  ///< of visible bodies, in the scene's order
    std::vector<std::string> warnings;
};

/// Looks at the frames, or at some hundred of them spread evenly.
/// @throws InputError   as Poses
SliceReport look_at_slice(const Scene& scene, const std::filesystem::path& trajectory,
                          const std::vector<int>& frames);

/// "\"ball\"  in the picture from 0.3 to 2.1 s, up to 23 % of its height".
std::string text_of(const InPicture& body);

}  // namespace tesserae::scenes
