// Parts of a frame, two of them in the input: the length of the first, 4 bytes, comes before it.
#include <cstring>

#include "render/file/part_file.hpp"
#include "render/file/whole_image.hpp"
#include "tests/fuzz/example.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    namespace fs = std::filesystem;
    std::uint32_t first = 0;
    if (size < sizeof first) return 0;
    std::memcpy(&first, data, sizeof first);
    const std::string_view rest = fuzz::text_of(data + sizeof first, size - sizeof first);
    const fuzz::MemoryFile one(rest.substr(0, first)),
        two(rest.size() > first ? rest.substr(first) : std::string_view());
    const fs::path parts[] = {one.path(), two.path()};
    static const fs::path folder = fuzz::memory_folder("part");
    const fs::path exr = folder / "joined.exr", preview = folder / "joined.png";
    for (const fs::path& part : parts) fuzz::accepts([&] { render::read_part_info(part); });
    const std::span<const fs::path> both(parts);
    for (std::size_t count : {1, 2}) {
        fs::remove(exr);
        fuzz::accepts([&] { render::join_parts(both.first(count), exr, preview); });
        fuzz::require(!fs::exists(exr.string() + ".partial"), "a partial file is left");
    }
    return 0;
}
