// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/compare/file_kind.hpp"

// What is in a file, apart from how it is stored: two files of equal content have equal hashes on
// any machine.
namespace tesserae::scenes {

/// One dataset, channel or frame.
struct ContentEntry {
    std::string name;
    std::string description;  ///< type and shape
    std::string hash;         ///< of the values: XXH3, 128 bits, 32 hexadecimal digits

    friend bool operator==(const ContentEntry&, const ContentEntry&) = default;
};

/// The content of a trajectory, image, scene or folder of frames. Its entries are
/// - of a trajectory every dataset, but of those below /parameters only the effective text: its
///   path and, for example, `float64 [5][3][8]` or `text []`;
/// - of an image every channel: its name and, for example, `half 0,0 to 64,48` with the data
///   window, half open;
/// - of a folder every frame: the file's name and `image`;
/// - of a scene `effective` and `motion`, both `text`.
///
/// Types are int8 to int64, uint8 to uint64, float32, float64, text; half, float, uint. Values are
/// hashed as little-endian bits, row by row, the last axis fastest; a text as its length in bytes
/// (a 64-bit number) and its bytes without padding. A frame's hash is that of its image's content,
/// a scene's are Scene::hash and Scene::motion_hash.
struct Content {
    FileKind kind = FileKind::kScene;
    std::vector<ContentEntry> entries;  ///< ascending by the bytes of their names

    /// The text that hash() is of: the lines `tesserae content 1` and the kind's name, then a line
    /// `"NAME" DESCRIPTION HASH` for each entry, every line ended by a line feed. In NAME a quote
    /// or backslash has a backslash before it, and a control character is written as a backslash,
    /// `u` and four hexadecimal digits.
    std::string manifest() const;

    /// hex_hash() of the manifest; of a scene that of its effective text.
    std::string hash() const;
};

/// Reads a file, or a folder's frames: all *.exr in its folder `frames` if it has one, else its
/// own. Uses the threads of the caller's parallel::Threads for a folder's images. Memory is bounded
/// by some MiB, a trajectory's chunks, or a row of an image's tiles.
/// @throws InputError   it cannot be read, is damaged, or is of a form that is not compared
Content read_content(const std::filesystem::path& path);

/// The files that a folder's content is of, ascending by name. @throws InputError   there are none
std::vector<std::filesystem::path> frames_in(const std::filesystem::path& folder);

/// An entry that is not the same in two contents.
struct EntryDifference {
    std::string name;
    std::string a, b;  ///< descriptions, empty where the entry is missing; equal: the values differ
};
std::vector<EntryDifference> differing_entries(const Content& a, const Content& b);

}  // namespace tesserae::scenes
