#pragma once

#include <filesystem>

namespace tesserae::render {

/// Goes through the header of an OpenEXR file, value by value: a first sieve of every file that is
/// opened, since OpenEXR takes memory for a value before it notices that the file is shorter.
/// @return the version with its flags
/// @throws std::runtime_error   why it is no such header; without the path
int checked_exr_version(const std::filesystem::path& path);

}  // namespace tesserae::render
