// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "render/mattes.hpp"
#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// What Cryptomatte layers call a scene's visible bodies and their materials: bodies of a lattice
/// NAME.0, NAME.1, ... in the order of their numbers, the material of those that name none
/// "default". Above 10,000 names of a layer its manifest is a file in `folder`, the frames' one,
/// which this writes; with no folder all stay in the header.
/// @throws RunError   as write_file
render::Mattes mattes_of(const Scene& scene, const std::filesystem::path& folder);

}  // namespace tesserae::scenes
