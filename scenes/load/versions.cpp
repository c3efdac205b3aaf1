// SPDX-License-Identifier: Apache-2.0
#include "scenes/load/versions.hpp"

#include <fmt/format.h>

#include "scenes/load/effective.hpp"
#include "scenes/load/hash.hpp"

namespace tesserae::scenes {
namespace {

void append_version(std::string& text, const char* key, int version) {
    if (version != 1) text += fmt::format("{} = {}\n", key, version);
}

}  // namespace

std::string motion_hash(std::string_view effective, int motion_version) {
    std::string text = motion_part(effective);
    append_version(text, "motion_version", motion_version);
    return hex_hash(text);
}

std::string frame_hash(std::string_view effective, int picture_version, int motion_version) {
    std::string text(effective);
    append_version(text, "picture_version", picture_version);
    append_version(text, "motion_version", motion_version);
    return hex_hash(text);
}

std::string other_motion_version(int there, int here) {
    return fmt::format(
        "was moved by motion version {}, this program moves by version {}: it can be rendered, not "
        "continued",
        there, here);
}

}  // namespace tesserae::scenes
