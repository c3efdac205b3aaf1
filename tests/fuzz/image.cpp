// SPDX-License-Identifier: Apache-2.0
// OpenEXR images: what `tesserae info`, `status`, `hash` and `diff` read of them.
#include "render/file/image_info.hpp"
#include "render/file/whole_image.hpp"
#include "scenes/compare/difference.hpp"
#include "scenes/program/info.hpp"
#include "tests/fuzz/example.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    static const std::string good = fuzz::example_image();
    static const fuzz::MemoryFile good_file(good);
    std::string bytes(fuzz::text_of(data, size));
    // Whatever else is there, it begins as an image.
    if (bytes.size() < 4) return 0;
    bytes.replace(0, 4, "\x76\x2f\x31\x01");
    const fuzz::MemoryFile file(bytes);
    fuzz::accepts([&] { render::is_whole_image(file.path()); });
    fuzz::accepts([&] {
        for (const scenes::Fact& fact : scenes::facts_about(file.path(), 1))
            fact.value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    });
    fuzz::accepts([&] { scenes::read_content(file.path()).hash(); });
    fuzz::accepts([&] { scenes::text_of(scenes::compare(good_file.path(), file.path())); });
    return 0;
}
