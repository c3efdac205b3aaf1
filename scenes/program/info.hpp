#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tesserae::scenes {

/// A summary of a scene, trajectory or image, told apart by content: names and values, in the order
/// to show them.
/// @throws InputError   the file cannot be read, or is none of the three
std::vector<std::pair<std::string, std::string>> facts_about(const std::filesystem::path& file,
                                                             int threads);

}  // namespace tesserae::scenes
