// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace tesserae::render
