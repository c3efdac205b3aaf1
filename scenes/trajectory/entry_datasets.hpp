// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/trajectory/hdf5.hpp"

namespace tesserae::scenes {

/// Bytes of a chunk of entries, and of what is in memory at once, usual 1 MiB.
inline constexpr std::uint64_t kEntryChunkBytes = 1 << 20;

/// Creates a compressed dataset of one entry for each of many things, and fills it piece by piece.
/// @param name   empty: nothing leads to it yet
/// @param copy   writes the entry of a thing, `bytes` long, over zeros; called in their order
template <class Copy>
hdf5::Handle create_entries(hid_t group, const std::string& name, hid_t type, std::size_t bytes,
                            std::uint64_t entries, Copy&& copy) {
    const std::uint64_t chunk =
        std::clamp<std::uint64_t>(entries, 1, std::max<std::uint64_t>(1, kEntryChunkBytes / bytes));
    hdf5::Handle dataset = hdf5::create_growing(group, name, type, {entries}, {chunk}, true);
    std::string piece;
    for (std::uint64_t begin = 0; begin < entries; begin += chunk) {
        const std::uint64_t count = std::min(chunk, entries - begin);
        piece.assign(count * bytes, '\0');
        for (std::uint64_t i = 0; i < count; ++i) copy(begin + i, piece.data() + i * bytes);
        hdf5::write_rows(dataset, begin, count, type, piece.data());
    }
    return dataset;
}

/// Reads a text of a fixed length of each of so many things, without the zeros that fill it up.
/// @param path   of the group, for messages
/// @throws hdf5::Failure   it has another type or shape, or more than its file can hold
std::vector<std::string> read_texts(hid_t group, const std::string& name, const std::string& path,
                                    std::uint64_t entries, std::uint64_t file_bytes);
/// The same of a real.
std::vector<double> read_reals(hid_t group, const std::string& name, const std::string& path,
                               std::uint64_t entries, std::uint64_t file_bytes);

}  // namespace tesserae::scenes
