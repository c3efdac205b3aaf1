// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tesserae::scenes {

/// Reads a whole scene file.
/// @throws InputError   missing, no permission, not a regular file, over 256 MB, or not text (NUL
///                      bytes, UTF-16)
std::string read_scene_file(const std::filesystem::path& file);

/// A piece of a text that starts at the beginning of a line.
struct TextPiece {
    std::string_view text;
    std::size_t lines_before = 0;
};

/// A scene's text cut into pieces that are parsed one by one: some [[body]] tables at a time, and
/// everything else. Parsing whole files of 10^6 bodies would take 15 bytes of memory for each of
/// the file, and toml++ 3.3 searches all dotted tables met so far for each second dotted key.
struct SceneText {
    std::string rest;               ///< the file with all [[body]] tables blanked, lines kept
    std::vector<TextPiece> bodies;  ///< whole [[body]] tables with their subtables, in file order
    std::size_t body_count = 0;     ///< [[body]] headers in `bodies`
};

/// Cuts a text and bounds what parsing it can cost: nesting and dots of a key (the parser recurses
/// without bound), values in a body and outside bodies. Knows strings and comments as TOML does; up
/// to the first error of an illegal text it sees the same tokens as the parser.
/// @param place   names the text in errors
/// @throws InputError   with place, line and column
SceneText cut_scene_text(std::string_view text, const std::string& place);

}  // namespace tesserae::scenes
