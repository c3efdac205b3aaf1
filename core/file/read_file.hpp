// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace tesserae {

/// Returns the bytes of a file.
/// @throws RunError   it cannot be opened or read to its end; with the path and the system's reason
std::string read_file(const std::filesystem::path& file);

}  // namespace tesserae
