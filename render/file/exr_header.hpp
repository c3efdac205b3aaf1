// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenEXR/ImfForward.h>

#include <cstdint>
#include <filesystem>
#include <stdexcept>

namespace tesserae::render {

/// The system could not read a file; what() is its reason.
struct ReadFailure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct ExrHeader {
    int version = 0;        ///< with its flags
    std::uint64_t end = 0;  ///< where the table of tiles or lines begins
};

/// Goes through the header of an OpenEXR file, value by value: a first sieve of every file that is
/// opened, since OpenEXR takes memory for a value before it notices that the file is shorter.
/// @throws std::runtime_error   why it is no such header, or a ReadFailure; without the path
ExrHeader checked_exr_header(const std::filesystem::path& path);

/// The values of a file's header, of the first one where it has several. OpenEXR's own files take
/// memory for the pixels that a header tells of as soon as they are opened; this takes none.
/// @throws std::exception   as checked_exr_header(), or what OpenEXR finds wrong with them
Imf::Header read_exr_header(const std::filesystem::path& path);

}  // namespace tesserae::render
