// SPDX-License-Identifier: Apache-2.0
// Folders of previews to make a film of. The program that is called as ffmpeg reads nothing.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "scenes/film/movie.hpp"
#include "scenes/load/load.hpp"
#include "tests/fuzz/example.hpp"
#include "tests/fuzz/reading.hpp"

namespace {

namespace fs = std::filesystem;

/// A folder with a program `ffmpeg` in it that ends at once, and nothing else on the path.
fs::path folder_with_ffmpeg() {
    const fs::path folder = tesserae::fuzz::memory_folder("previews");
    fs::create_directories(folder / "bin");
    fs::create_symlink("/bin/true", folder / "bin" / "ffmpeg");
    ::setenv("PATH", (folder / "bin").c_str(), 1);
    return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    static const fs::path folder = folder_with_ffmpeg();
    static const scenes::Scene scene =
        scenes::load_scene_text("scene.toml", fuzz::kSceneOfEverything, {});
    FuzzedDataProvider input(data, size);
    fs::remove_all(folder / "preview"), fs::remove_all(folder / "frames");
    fs::create_directories(folder / "preview"), fs::create_directories(folder / "frames");
    for (int i = 0; i < 4 && input.remaining_bytes() > 0; ++i) {
        const bool is_frame = input.ConsumeIntegralInRange(0, 7) == 0;
        std::string number = input.ConsumeRandomLengthString(12);
        std::replace_if(
            number.begin(), number.end(), [](char c) { return c == '/' || c == '\0'; }, '0');
        std::string bytes = input.ConsumeRandomLengthString(200);
        if (input.ConsumeIntegralInRange(0, 3) != 0) bytes.insert(0, "\x89PNG\r\n\x1a\n");
        std::ofstream(folder / (is_frame ? "frames" : "preview") /
                          ("film." + number + (is_frame ? ".exr" : ".png")),
                      std::ios::binary)
            << bytes;
    }
    fuzz::accepts([&] {
        scenes::is_movie_current(scene, folder);
        try {
            const scenes::MovieReport report = scenes::make_movie(scene, folder, true);
            fuzz::require(std::isfinite(report.frames_per_second) && report.frames_per_second > 0,
                          "a film of no frames per second");
        } catch (const RunError&) {
            // It reads no previews.
        }
    });
    return 0;
}
