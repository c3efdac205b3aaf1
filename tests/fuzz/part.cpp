// SPDX-License-Identifier: Apache-2.0
// Parts of a frame, two of them in the input: the length of the first, 4 bytes, comes before it.
// Every second input gets the checksums that its bytes have, or hardly any would be looked into.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cstring>

#include "render/file/part_file.hpp"
#include "render/file/whole_image.hpp"
#include "tests/fuzz/example.hpp"
#include "tests/fuzz/reading.hpp"

namespace {

/// A part ends with a checksum of all before it.
std::string with_checksum(std::string_view part) {
    std::string bytes(part);
    if (bytes.size() < sizeof(std::uint64_t)) return bytes;
    const std::size_t end = bytes.size() - sizeof(std::uint64_t);
    const std::uint64_t checksum = XXH3_64bits(bytes.data(), end);
    std::memcpy(&bytes[end], &checksum, sizeof checksum);
    return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    namespace fs = std::filesystem;
    std::uint32_t first = 0;
    if (size < sizeof first) return 0;
    std::memcpy(&first, data, sizeof first);
    const std::string_view rest = fuzz::text_of(data + sizeof first, size - sizeof first);
    const std::string_view begin = rest.substr(0, first),
                           end = rest.size() > first ? rest.substr(first) : std::string_view();
    const bool mends = size % 2 == 0;
    const fuzz::MemoryFile one(mends ? with_checksum(begin) : std::string(begin)),
        two(mends ? with_checksum(end) : std::string(end));
    const fs::path parts[] = {one.path(), two.path()};
    static const fs::path folder = fuzz::memory_folder("part");
    const fs::path exr = folder / "joined.exr", preview = folder / "joined.png";
    for (const fs::path& part : parts) {
        fuzz::accepts([&] { render::read_part_info(part); });
        fuzz::accepts([&] { render::damage_of_part(part); });
    }
    const std::span<const fs::path> both(parts);
    for (std::size_t count : {1, 2}) {
        fs::remove(exr);
        fuzz::accepts([&] { render::join_parts(both.first(count), exr, preview); });
        fuzz::require(!fs::exists(exr.string() + ".partial"), "a partial file is left");
    }
    return 0;
}
