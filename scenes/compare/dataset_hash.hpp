// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "scenes/trajectory/dataset_storage.hpp"

namespace tesserae::scenes {

/// A dataset's type and shape, and the hash of its values, as Content describes them.
struct DatasetContent {
    std::string description, hash;
    double bytes = 0;  ///< that its elements take in memory
};

/// Reads in slabs of at most 256 MiB (usual 8 MiB), so that every chunk is decompressed once or at
/// most 8 times.
/// @throws hdf5::Failure   begins with `name`: of a type that is not compared, or checked_storage()
DatasetContent content_of(const hdf5::Handle& dataset, const std::string& name,
                          std::uint64_t file_bytes);

}  // namespace tesserae::scenes
