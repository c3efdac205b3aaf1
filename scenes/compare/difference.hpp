// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "scenes/compare/content.hpp"
#include "scenes/compare/image_difference.hpp"
#include "scenes/compare/trajectory_difference.hpp"

namespace tesserae::scenes {

/// All that `tesserae diff` says of two files, or folders of frames, of one kind.
struct Difference {
    FileKind kind = FileKind::kScene;
    std::string hash_a, hash_b;  ///< equal: so is the content, and the rest is empty
    std::vector<EntryDifference> entries;
    std::optional<TrajectoryDifference> trajectory;
    std::string frame;  ///< of folders: the first frame in both that differs
    std::optional<ImageDifference> image;
    std::string scene, motion;  ///< of scenes: first differences, of all and of what moves bodies

    bool is_equal() const { return hash_a == hash_b; }
};

/// Compares the contents first, and looks for places only where these differ: equal hashes and "no
/// difference" are the same. Uses the threads of the caller's parallel::Threads for frames.
/// @throws InputError   one cannot be read, or they are of different kinds
Difference compare(const std::filesystem::path& a, const std::filesystem::path& b);

/// Sentences and tables for people, without a line feed at the end. Effective scenes' differences
/// say "there" for A and "here" for B.
std::string text_of(const Difference& difference);

}  // namespace tesserae::scenes
