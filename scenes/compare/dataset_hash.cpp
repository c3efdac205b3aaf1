// SPDX-License-Identifier: Apache-2.0
#include "scenes/compare/dataset_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "scenes/load/hash.hpp"

namespace tesserae::scenes {
namespace {

using hdf5::checked;
using hdf5::Extent;
using hdf5::Handle;

/// Bytes of a slab where chunks are smaller, usual 8 MiB.
constexpr double kSlabBytes = 8 << 20;
/// Bytes of a slab that takes whole chunks: beyond it they are decompressed several times, which
/// takes hours for what gzip made very small.
constexpr double kMostSlabBytes = 256 << 20;
constexpr double kMostRepeats = 8;
/// Chunks of a slab, for each of which HDF5 takes 2 KB of memory. Usual 4096. Less: slower.
constexpr double kMostChunks = 4096;

/// A type of values as it is hashed: little-endian numbers, or texts as they are stored.
struct ValueType {
    std::string name;
    Handle memory;
    std::size_t bytes = 0;
    bool is_text = false;
    H5T_str_t padding = H5T_STR_NULLPAD;  ///< of a text
};

Handle copy_of(hid_t type) { return {H5Tcopy(type), H5Tclose}; }

bool is_one_of(const Handle& type, std::initializer_list<hid_t> candidates) {
    return std::any_of(candidates.begin(), candidates.end(),
                       [&](hid_t t) { return checked(H5Tequal(type.get(), t)) > 0; });
}

ValueType type_of(const Handle& dataset, const std::string& name) {
    const Handle type(H5Dget_type(dataset.get()), H5Tclose);
    const std::size_t bytes = H5Tget_size(type.get());
    if (checked(H5Tget_class(type.get())) == H5T_STRING) {
        if (checked(H5Tis_variable_str(type.get())) > 0)
            throw hdf5::Failure(name + ": holds texts of variable length; expected a fixed one");
        return {"text", copy_of(type.get()), bytes, true, H5Tget_strpad(type.get())};
    }
    const struct {
        const char* name;
        hid_t little, big;
    } kNumbers[] = {
        {"float64", H5T_IEEE_F64LE, H5T_IEEE_F64BE}, {"float32", H5T_IEEE_F32LE, H5T_IEEE_F32BE},
        {"int64", H5T_STD_I64LE, H5T_STD_I64BE},     {"int32", H5T_STD_I32LE, H5T_STD_I32BE},
        {"int16", H5T_STD_I16LE, H5T_STD_I16BE},     {"int8", H5T_STD_I8LE, H5T_STD_I8BE},
        {"uint64", H5T_STD_U64LE, H5T_STD_U64BE},    {"uint32", H5T_STD_U32LE, H5T_STD_U32BE},
        {"uint16", H5T_STD_U16LE, H5T_STD_U16BE},    {"uint8", H5T_STD_U8LE, H5T_STD_U8BE}};
    for (const auto& number : kNumbers)
        if (is_one_of(type, {number.little, number.big}))
            return {number.name, copy_of(number.little), bytes};
    throw hdf5::Failure(name +
                        ": is of a type that is not compared; expected integers, float32, float64 "
                        "or texts of fixed length");
}

/// Bytes of a stored text without its padding.
std::size_t text_length(const char* text, std::size_t bytes, H5T_str_t padding) {
    if (padding == H5T_STR_NULLTERM)
        return static_cast<std::size_t>(std::find(text, text + bytes, '\0') - text);
    const char pad = padding == H5T_STR_SPACEPAD ? ' ' : '\0';
    while (bytes > 0 && text[bytes - 1] == pad) --bytes;
    return bytes;
}

void add_values(StreamHash& hash, const ValueType& type, const char* values, std::size_t count) {
    if (!type.is_text) return hash.add(values, count * type.bytes);
    static_assert(std::endian::native == std::endian::little);
    for (std::size_t i = 0; i < count; ++i) {
        const char* text = values + i * type.bytes;
        const std::uint64_t length = text_length(text, type.bytes, type.padding);
        hash.add(&length, sizeof length);
        hash.add(text, length);
    }
}

/// How a dataset is cut: one index along each axis before `axis`, `rows` along it, all after it.
struct Cut {
    std::size_t axis = 0;
    hsize_t rows = 1;
};

/// Returns how many chunks one chunk along an axis has along all after it.
double chunks_after(const DatasetStorage& storage, std::size_t axis) {
    double chunks = 1;
    for (std::size_t i = axis + 1; i < storage.chunk.size(); ++i)
        chunks *= std::ceil(static_cast<double>(storage.extent[i]) /
                            static_cast<double>(storage.chunk[i]));
    return chunks;
}

/// The first axis along which whole chunks, or else some rows, fit into a slab.
Cut cut_of(const DatasetStorage& storage, std::size_t element_bytes, const std::string& name) {
    const Extent& extent = storage.extent;
    double row_bytes = storage.bytes, repeats = 1;
    for (std::size_t axis = 0;; ++axis) {
        const bool is_last = axis + 1 == extent.size();
        row_bytes = is_last ? static_cast<double>(element_bytes)
                            : row_bytes / static_cast<double>(extent[axis]);
        const hsize_t chunk =
            storage.chunk.empty() ? 1 : std::min(storage.chunk[axis], extent[axis]);
        const auto whole = static_cast<double>(chunk);
        const double chunks = chunks_after(storage, axis);
        if ((row_bytes <= kMostSlabBytes && chunks <= kMostChunks) || is_last) {
            const auto rows_in = [&](double bytes) {
                return std::max(1.0, std::floor(bytes / row_bytes));
            };
            double rows = rows_in(kSlabBytes);
            if (!storage.chunk.empty())
                rows = std::min(rows, whole * std::max(1.0, std::floor(kMostChunks / chunks)));
            if (whole * row_bytes <= kMostSlabBytes) {
                rows = std::max(whole, rows - std::fmod(rows, whole));
            } else {
                rows = rows_in(kMostSlabBytes);
                repeats *= std::ceil(whole / rows);
            }
            if (repeats > kMostRepeats) break;
            return {axis, static_cast<hsize_t>(std::min(rows, static_cast<double>(extent[axis])))};
        }
        repeats *= whole;
    }
    throw hdf5::Failure(name +
                        ": is stored in chunks that cannot be read in its order; expected "
                        "chunks of fewer rows");
}

/// Reads slab after slab in the order of the elements.
void hash_slabs(const Handle& dataset, const ValueType& type, const Extent& extent, const Cut& cut,
                StreamHash& hash) {
    const Handle file(H5Dget_space(dataset.get()), H5Sclose);
    Extent start(extent.size(), 0), count = extent;
    std::fill_n(count.begin(), cut.axis, 1);
    std::vector<char> values;
    while (start[0] < extent[0]) {
        count[cut.axis] = std::min(cut.rows, extent[cut.axis] - start[cut.axis]);
        hsize_t elements = 1;
        for (hsize_t side : count) elements *= side;
        values.resize(elements * type.bytes);
        checked(H5Sselect_hyperslab(file.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(),
                                    nullptr));
        const Handle memory(H5Screate_simple(1, &elements, nullptr), H5Sclose);
        checked(H5Dread(dataset.get(), type.memory.get(), memory.get(), file.get(), H5P_DEFAULT,
                        values.data()));
        add_values(hash, type, values.data(), elements);

        // The next slab; a full axis carries into the one before.
        start[cut.axis] += count[cut.axis];
        for (std::size_t axis = cut.axis; axis > 0 && start[axis] == extent[axis]; --axis)
            start[axis] = 0, ++start[axis - 1];
    }
}

}  // namespace

DatasetContent content_of(const Handle& dataset, const std::string& name,
                          std::uint64_t file_bytes) {
    const ValueType type = type_of(dataset, name);
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    if (H5Sget_simple_extent_type(space.get()) == H5S_NULL)
        throw hdf5::Failure(name + ": has no values, not even a shape");
    const DatasetStorage storage = checked_storage(dataset, name, file_bytes);
    if (type.bytes > file_bytes) throw hdf5::Failure(name + ": a text is longer than the file");

    StreamHash hash;
    if (storage.extent.empty()) {
        std::vector<char> value(type.bytes);
        checked(
            H5Dread(dataset.get(), type.memory.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()));
        add_values(hash, type, value.data(), 1);
    } else if (storage.bytes > 0) {
        hash_slabs(dataset, type, storage.extent, cut_of(storage, type.bytes, name), hash);
    }
    std::string description = type.name + " ";
    for (hsize_t side : storage.extent) description += fmt::format("[{}]", side);
    if (storage.extent.empty()) description += "[]";
    return {std::move(description), hash.hex(), storage.bytes};
}

}  // namespace tesserae::scenes
