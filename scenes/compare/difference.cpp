// SPDX-License-Identifier: Apache-2.0
#include "scenes/compare/difference.hpp"

#include <algorithm>

#include "core/error.hpp"
#include "scenes/load/effective.hpp"
#include "scenes/load/load.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

void compare_scenes(const fs::path& a, const fs::path& b, Difference& difference) {
    const std::string effective_a = load_scene(a, {}).effective;
    const std::string effective_b = load_scene(b, {}).effective;
    difference.scene = first_difference(effective_a, effective_b);
    difference.motion = first_motion_difference(effective_a, effective_b);
}

/// The place of a frame among those of a folder.
fs::path frame_of(const fs::path& folder, const std::string& name) {
    return frames_in(folder).front().parent_path() / name;
}

void compare_frames(const fs::path& a, const fs::path& b, Difference& difference) {
    const auto first =
        std::find_if(difference.entries.begin(), difference.entries.end(),
                     [](const EntryDifference& e) { return !e.a.empty() && !e.b.empty(); });
    if (first == difference.entries.end()) return;
    difference.frame = first->name;
    difference.image = compare_images(frame_of(a, first->name), frame_of(b, first->name));
}

}  // namespace

Difference compare(const fs::path& a, const fs::path& b) {
    const Content in_a = read_content(a), in_b = read_content(b);
    if (in_a.kind != in_b.kind)
        throw InputError(fmt::format("{} ({}), {} ({}): expected two of one kind", a.string(),
                                     name_of(in_a.kind), b.string(), name_of(in_b.kind)));
    Difference difference;
    difference.kind = in_a.kind;
    difference.hash_a = in_a.hash(), difference.hash_b = in_b.hash();
    if (difference.is_equal()) return difference;
    difference.entries = differing_entries(in_a, in_b);
    switch (difference.kind) {
        case FileKind::kTrajectory:
            difference.trajectory = compare_trajectories(a, b);
            break;
        case FileKind::kImage:
            difference.image = compare_images(a, b);
            break;
        case FileKind::kFrames:
            compare_frames(a, b, difference);
            break;
        case FileKind::kScene:
            compare_scenes(a, b, difference);
            break;
    }
    return difference;
}

}  // namespace tesserae::scenes
