// SPDX-License-Identifier: Apache-2.0
#include "render/file/whole_image.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <vector>

#include "core/error.hpp"
#include "render/file/exr_header.hpp"

namespace tesserae::render {
namespace {

/// A number of the file, little-endian as on every machine that this is built for.
template <class T>
T number(std::istream& in) {
    T value = {};
    in.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
}

/// Flags of the version (OpenEXR's "File Layout").
constexpr std::uint32_t kTiled = 0x200, kDeep = 0x800, kSeveralParts = 0x1000;

/// The system has not failed.
void require_read(const std::ifstream& in, const std::filesystem::path& file) {
    if (!in.is_open() || in.bad())
        throw InputError(
            fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
}

/// Where the header ends; none: it is cut off or damaged.
std::optional<std::uint64_t> end_of_header(const std::filesystem::path& file) {
    try {
        return checked_exr_header(file).end;
    } catch (const ReadFailure& failure) {
        throw InputError(fmt::format("{}: cannot be read: {}", file.string(), failure.what()));
    } catch (const std::runtime_error&) {
        return {};
    }
}

}  // namespace

bool is_whole_image(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const auto magic = number<std::uint32_t>(in);
    require_read(in, file);
    if (magic != 20000630u || !in)
        throw InputError(fmt::format("{}: not a readable OpenEXR image", file.string()));
    const auto version = number<std::uint32_t>(in);
    if ((version & (kDeep | kSeveralParts)) != 0) return true;
    const std::optional<std::uint64_t> end = end_of_header(file);
    if (!end) return false;
    const std::uint64_t begin = *end, size = std::filesystem::file_size(file);
    in.seekg(static_cast<std::streamoff>(begin));
    // The table ends where the first of them begins, and that is the least number in it.
    std::uint64_t first = size, last = 0;
    for (std::uint64_t at = begin; at + sizeof(std::uint64_t) <= first; at += sizeof at) {
        const auto offset = number<std::uint64_t>(in);
        require_read(in, file);
        if (!in || offset < begin || offset >= size) return false;
        first = std::min(first, offset), last = std::max(last, offset);
    }
    // A tile: column, row, two levels, the count of its bytes, the bytes. Lines: the first one's
    // number, the count of their bytes, the bytes.
    const std::uint64_t place = (version & kTiled) != 0 ? 4 : 1;
    in.seekg(static_cast<std::streamoff>(last + place * sizeof(std::int32_t)));
    const auto bytes = number<std::int32_t>(in);
    require_read(in, file);
    return in && bytes >= 0 &&
           last + (place + 1) * sizeof(std::int32_t) + static_cast<std::uint64_t>(bytes) <= size;
}

}  // namespace tesserae::render
