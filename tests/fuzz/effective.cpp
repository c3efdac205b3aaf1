// SPDX-License-Identifier: Apache-2.0
// Canonical texts as they come from trajectories and folders, which anyone may have changed: two of
// them, parted by a zero byte, are compared line by line.
#include "scenes/load/effective.hpp"

#include "scenes/compare/trajectory_difference.hpp"
#include "scenes/load/scene_text.hpp"
#include "scenes/load/versions.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace tesserae;
    const std::string_view all = fuzz::text_of(data, size);
    const std::size_t end = all.find('\0');
    const std::string there(all.substr(0, end));
    const std::string here(end == std::string_view::npos ? "" : all.substr(end + 1));
    const bool equal = scenes::first_difference(there, here).empty();
    fuzz::require(equal == scenes::first_difference(here, there).empty(),
                  "a difference depends on the order");
    fuzz::require(scenes::first_difference(there, there).empty(), "a text differs from itself");
    scenes::first_motion_difference(there, here);
    scenes::same_body_names(there, here);
    scenes::without_duration(there);
    scenes::frame_hash(there, 2, 3);
    scenes::motion_hash(there, 2);
    for (const std::uint64_t body : {std::uint64_t{0}, std::uint64_t{5}, ~std::uint64_t{0}})
        scenes::body_name(there, body);
    return 0;
}
