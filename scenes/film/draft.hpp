// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// A draft renders every so many frames.
constexpr int kDraftStride = 2;

/// Entries for load_scene() that make a quick picture of a scene's: a third as wide and high, a
/// quarter of the samples, direct light, ghosts over it unless the scene says how deep they are.
/// With every second frame it costs a tenth, or less.
std::vector<std::string> draft_overrides(const Scene& scene);

}  // namespace tesserae::scenes
