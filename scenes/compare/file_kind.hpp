// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace tesserae::scenes {

/// What a path holds.
enum class FileKind {
    kTrajectory,
    kImage,
    kScene,
    kFrames,  ///< a folder
};

/// "trajectory", "image", "scene", "frames".
const char* name_of(FileKind kind);

/// Told by the file's first bytes, not by its name: what is neither HDF5 nor OpenEXR, nor a folder,
/// is taken for a scene, whose loader also says what is not there at all.
/// @throws InputError   the system does not let it be read
FileKind kind_of(const std::filesystem::path& path);

}  // namespace tesserae::scenes
