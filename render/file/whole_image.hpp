#pragma once

#include <filesystem>

namespace tesserae::render {

/// Whether a tiled OpenEXR file ends where its table of tiles says that the last one ends: a copy
/// that was cut off does not. Reads the header and the table, not the tiles.
/// @throws InputError   it cannot be read, or is no tiled OpenEXR file
bool is_whole_image(const std::filesystem::path& file);

}  // namespace tesserae::render
