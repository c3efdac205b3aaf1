// SPDX-License-Identifier: Apache-2.0
#include "core/file/read_file.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.hpp"

namespace tesserae {

std::string read_file(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string bytes;
    std::array<char, 65536> piece;
    // Not through <<, which tells a failure of reading no other than the end of the file.
    while (in.read(piece.data(), piece.size()) || in.gcount() > 0)
        bytes.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    if (!in.is_open() || in.bad())
        throw RunError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
    return bytes;
}

}  // namespace tesserae
