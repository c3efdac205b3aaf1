// SPDX-License-Identifier: Apache-2.0
#include "scenes/compare/file_kind.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "core/error.hpp"

namespace tesserae::scenes {

const char* name_of(FileKind kind) {
    constexpr const char* kNames[] = {"trajectory", "image", "scene", "frames"};
    return kNames[static_cast<std::size_t>(kind)];
}

FileKind kind_of(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) return FileKind::kFrames;
    std::array<unsigned char, 8> start = {};
    if (std::filesystem::is_regular_file(path, ignored)) {
        std::ifstream in(path, std::ios::binary);
        // A scene may be shorter.
        if (!in.read(reinterpret_cast<char*>(start.data()), start.size()) && !in.eof())
            throw InputError(
                fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    }
    if (start == std::array<unsigned char, 8>{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'})
        return FileKind::kTrajectory;
    if (start[0] == 0x76 && start[1] == 0x2f && start[2] == 0x31 && start[3] == 0x01)
        return FileKind::kImage;
    return FileKind::kScene;
}

}  // namespace tesserae::scenes
