// SPDX-License-Identifier: Apache-2.0
// The command line, a word a line, and what its numbers then mean to a scene.
#include "scenes/program/command_line.hpp"

#include <sstream>

#include "scenes/load/load.hpp"
#include "scenes/timeline.hpp"
#include "tests/fuzz/example.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    tesserae::fuzz::limit_memory();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    std::istringstream lines{std::string(fuzz::text_of(data, size))};
    std::vector<std::string> words = {"tesserae"};
    // A word of a command line ends at a zero byte.
    for (std::string line; std::getline(lines, line);) words.emplace_back(line.c_str());
    std::vector<const char*> pointers;
    for (const std::string& word : words) pointers.push_back(word.c_str());
    fuzz::accepts([&] {
        const scenes::CommandLine line =
            scenes::parse_command_line(static_cast<int>(pointers.size()), pointers.data());
        if (line.tiles)
            fuzz::require(line.tiles->number >= 1 && line.tiles->number <= line.tiles->count,
                          "a part of no frame");
        const scenes::Scene scene =
            scenes::load_scene_text("scene.toml", fuzz::kSceneOfEverything, line.sets);
        const render::Crop window = scene.render.window();
        fuzz::require(window.x0 >= 0 && window.x0 < window.x1 && window.x1 <= scene.render.width &&
                          window.y0 >= 0 && window.y0 < window.y1 &&
                          window.y1 <= scene.render.height,
                      "a window beyond the frame");
        scenes::parse_frames(line.frames, scenes::frame_count(scene));
    });
    return 0;
}
