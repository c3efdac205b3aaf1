// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scenes/scene.hpp"

namespace tesserae::scenes {

/// Reads, overrides, checks and expands a scene file.
/// @param sets   "KEY=VALUE" in order, as for --set; see Overrides
/// @throws InputError   the file cannot be read, or anything in it is wrong:
///                      `file:line:column: body 3 "crate": radius = -1: expected ...`
///
/// Limits beyond the format's: no real is larger than kLargest, no positive one smaller than
/// kSmallest, masses are 1e-60 to 1e60 kg. Default names are body-N, N counting the [[body]] tables
/// from 0 and then the [[lattice]] tables. Bodies of equal shape, mass, surface and looks share a
/// BodyType; types are numbered as they are first met.
Scene load_scene(const std::filesystem::path& file, std::span<const std::string> sets);

/// The same of a text that was read already, for example from a trajectory.
/// @param file   it was read from: names it in errors
Scene load_scene_text(const std::filesystem::path& file, std::string text,
                      std::span<const std::string> sets);

}  // namespace tesserae::scenes
