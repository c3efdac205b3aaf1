// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/trajectory/hdf5.hpp"

namespace tesserae::scenes {

/// The most that gzip can shrink anything.
inline constexpr std::uint64_t kMostCompression = 1032;

/// How a dataset lies in its file.
struct DatasetStorage {
    hdf5::Extent extent;
    hdf5::Extent chunk;  ///< empty: in one piece
    double bytes = 0;    ///< of all its elements
};

/// Refuses what reads other files or runs other code, and what asks for memory beyond what the file
/// can hold: only chunked, contiguous and compact layouts in this file, only the filters shuffle,
/// deflate and fletcher32, chunks of at most 256 MiB, no more bytes than gzip can make of those
/// stored.
/// @throws hdf5::Failure   begins with `name`
DatasetStorage checked_storage(const hdf5::Handle& dataset, const std::string& name,
                               std::uint64_t file_bytes);

}  // namespace tesserae::scenes
