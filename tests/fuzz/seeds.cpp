// SPDX-License-Identifier: Apache-2.0
// Writes what the targets for binary files start from: fuzz_seeds FOLDER, a folder a target.
#include <cstdio>
#include <cstring>
#include <exception>

#include "core/file/file_writer.hpp"
#include "render/file/part_file.hpp"
#include "scenes/load/load.hpp"
#include "tests/fuzz/example.hpp"
#include "tests/scenes/compare/written_files.hpp"

namespace tesserae::fuzz {
namespace {

namespace fs = std::filesystem;

void write_images(const fs::path& folder) {
    const scenes::testing::WrittenImage image;
    for (const int tile : {0, 8})
        for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
            image.write(folder / ("tile" + std::to_string(tile) + "-compression" +
                                  std::to_string(compression) + ".exr"),
                        tile, static_cast<Imf::Compression>(compression), "a note");
    write_file(folder / "frame.exr", example_image());
}

void write_parts(const fs::path& folder) {
    const auto parts = example_parts();
    const auto first = static_cast<std::uint32_t>(parts[0].size());
    std::string both(sizeof first, '\0');
    std::memcpy(both.data(), &first, sizeof first);
    write_file(folder / "two", both + parts[0] + parts[1]);
    // One that is all of its frame.
    const std::string one = example_parts(1)[0];
    const auto length = static_cast<std::uint32_t>(one.size());
    std::memcpy(both.data(), &length, sizeof length);
    write_file(folder / "one", both + one);
}

}  // namespace
}  // namespace tesserae::fuzz

int main(int argc, char** argv) try {
    namespace fs = std::filesystem;
    if (argc != 2) return std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n"), 2;
    const fs::path root = argv[1];
    fs::create_directories(root / "image"), fs::create_directories(root / "part");
    tesserae::fuzz::write_images(root / "image");
    tesserae::fuzz::write_parts(root / "part");
    return 0;
} catch (const std::exception& error) {
    return std::fprintf(stderr, "fuzz_seeds: %s\n", error.what()), 1;
}
