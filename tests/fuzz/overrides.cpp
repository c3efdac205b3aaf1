// SPDX-License-Identifier: Apache-2.0
// --set KEY=VALUE, an entry a line, on a scene that has one of everything.
#include <sstream>

#include "scenes/load/load.hpp"
#include "tests/fuzz/example.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    tesserae::fuzz::limit_memory();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    std::istringstream lines{std::string(fuzz::text_of(data, size))};
    std::vector<std::string> sets;
    for (std::string line; std::getline(lines, line);) sets.push_back(line);
    fuzz::accepts([&] { scenes::load_scene_text("scene.toml", fuzz::kSceneOfEverything, sets); });
    return 0;
}
