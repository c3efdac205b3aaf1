#pragma once

#include <string>
#include <vector>

#include "render/description.hpp"

namespace tesserae::scenes {

/// A draft renders every so many frames.
constexpr int kDraftStride = 2;

/// Entries for load_scene() that make a quick picture of a scene's: a third as wide and high, a
/// quarter of the samples, direct light. With every second frame it costs a tenth, or less.
std::vector<std::string> draft_overrides(const render::Settings& settings);

}  // namespace tesserae::scenes
