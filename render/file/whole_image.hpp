// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace tesserae::render {

/// Whether an OpenEXR file reaches to where its table of tiles or lines says that the last of them
/// ends: a copy that was cut off does not. Reads the header and the table, not the pixels. Files of
/// several parts or of deep pixels, which this program does not make, are taken for whole.
/// @throws InputError   it cannot be read, or is no OpenEXR file
bool is_whole_image(const std::filesystem::path& file);

}  // namespace tesserae::render
