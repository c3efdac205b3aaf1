// SPDX-License-Identifier: Apache-2.0
#include "scenes/process/version.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/dynamics/motion_version.hpp"
#include "render/picture_version.hpp"

// CMakeLists.txt defines TESSERAE_VERSION, TESSERAE_COMPILER, TESSERAE_SETTINGS and
// TESSERAE_LIBRARIES for this source alone: where one of them changes, only this is compiled again.
namespace tesserae::scenes {

std::string program_version() { return TESSERAE_VERSION; }

std::string version_line() {
    return fmt::format("tesserae {} (motion version {}, picture version {})", TESSERAE_VERSION,
                       kMotionVersion, render::kPictureVersion);
}

std::string version_text(const Commit& commit) {
    const std::string id =
        commit.id.empty()
            ? std::string("unknown: built from sources without their repository")
            : fmt::format("{}{}", commit.id, commit.has_changes ? " with changes" : "");
    return fmt::format("{}\ncommit     {}\ncompiler   {}, {}\nlibraries  {}\n", version_line(), id,
                       TESSERAE_COMPILER, TESSERAE_SETTINGS, TESSERAE_LIBRARIES);
}

nlohmann::ordered_json version_json(const Commit& commit) {
    nlohmann::ordered_json json = {{"version", program_version()},
                                   {"motion_version", kMotionVersion},
                                   {"picture_version", render::kPictureVersion},
                                   {"commit", nullptr},
                                   {"compiler", TESSERAE_COMPILER},
                                   {"settings", TESSERAE_SETTINGS}};
    if (!commit.id.empty()) {
        json["commit"] = commit.id;
        json["has_changes"] = commit.has_changes;
    }
    // "oneTBB 2021.8, Eigen 3.4": names and versions hold no blank.
    std::string_view left = TESSERAE_LIBRARIES;
    while (!left.empty()) {
        const std::string_view library = left.substr(0, left.find(", "));
        const std::size_t blank = library.find(' ');
        json["libraries"][std::string(library.substr(0, blank))] = library.substr(blank + 1);
        left.remove_prefix(std::min(left.size(), library.size() + 2));
    }
    return json;
}

}  // namespace tesserae::scenes
