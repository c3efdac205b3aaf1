// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// A line for each of the deepest pairs of bodies that start inside each other and that contacts
/// will push apart, with their names and how deep; none for a still.
std::vector<std::string> overlap_warnings(const Scene& scene);

}  // namespace tesserae::scenes
