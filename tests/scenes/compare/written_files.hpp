// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <hdf5.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/scenes/trajectory/datasets.hpp"
#include "tests/scenes/trajectory/trajectory_rows.hpp"

// Files to compare, written with HDF5's and OpenEXR's own interfaces.
namespace tesserae::scenes::testing {

constexpr std::size_t kTestBodies = 3;

/// A finished trajectory of made-up rows; `change` may alter a row.
template <class Change>
void write_trajectory(const std::filesystem::path& path, const TrajectoryHeader& header,
                      std::uint64_t rows, Change&& change) {
    TrajectoryWriter writer(path, header, make_steps(rows), false);
    for (std::uint64_t i = 0; i < rows; ++i) {
        Row row = make_row(i, header.bodies, header.joints.size());
        change(i, row);
        writer.append(row.facts, row.bodies, row.memory);
    }
    writer.finish();
}

inline void write_trajectory(const std::filesystem::path& path, std::uint64_t rows = 5) {
    write_trajectory(path, make_header(kTestBodies), rows, [](std::uint64_t, Row&) {});
}

/// How a copy of a trajectory is stored.
struct Form {
    bool chunked = false, compressed = false, big_endian = false;
    hsize_t chunk = 2;  ///< along every axis, at most
};

/// Writes a dataset's values, as they are in memory, under a name in another file. A text gets more
/// room and, where numbers are big-endian, another padding.
inline void copy_dataset(hid_t dataset, const std::string& bytes, hid_t to, const std::string& name,
                         const Form& form) {
    const hid_t memory = H5Dget_type(dataset), type = H5Tcopy(memory);
    const hid_t space = H5Dget_space(dataset), creation = H5Pcreate(H5P_DATASET_CREATE);
    if (H5Tget_class(type) == H5T_STRING) {
        H5Tset_size(type, H5Tget_size(type) + 5);
        if (form.big_endian) H5Tset_strpad(type, H5T_STR_SPACEPAD);
    } else if (form.big_endian) {
        H5Tset_order(type, H5T_ORDER_BE);
    }
    // Of a fixed extent: what grows is stored in chunks only.
    const int rank = H5Sget_simple_extent_ndims(space);
    std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
    H5Sget_simple_extent_dims(space, extent.data(), nullptr);
    const hid_t fixed =
        rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, extent.data(), nullptr);
    if (form.chunked && rank > 0) {
        std::vector<hsize_t> chunk = extent;
        for (hsize_t& side : chunk) side = std::clamp<hsize_t>(side, 1, form.chunk);
        H5Pset_chunk(creation, rank, chunk.data());
        if (form.compressed) H5Pset_fletcher32(creation), H5Pset_deflate(creation, 9);
    }
    const hid_t copy =
        H5Dcreate2(to, name.c_str(), type, fixed, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Dwrite(copy, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data());
    H5Dclose(copy);
    for (hid_t id : {fixed, space}) H5Sclose(id);
    for (hid_t id : {type, memory}) H5Tclose(id);
    H5Pclose(creation);
}

/// Copies groups and datasets, no attributes; every name becomes a dataset of its own.
inline void copy_in_form(const std::filesystem::path& from, const std::filesystem::path& to,
                         const Form& form) {
    const auto datasets = datasets_of(from);
    const hid_t in = H5Fopen(from.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t out = H5Fcreate(to.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    for (const auto& [name, bytes] : datasets) {
        const hid_t object = H5Oopen(in, name.c_str(), H5P_DEFAULT);
        if (H5Iget_type(object) == H5I_DATASET)
            copy_dataset(object, bytes, out, name, form);
        else
            H5Gclose(H5Gcreate2(out, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
        H5Oclose(object);
    }
    H5Fclose(in);
    H5Fclose(out);
}

/// Stores a trajectory's rows in another form, in the same file.
inline void rewrite_in_form(const std::filesystem::path& path, const Form& form) {
    const auto datasets = datasets_of(path);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    for (const auto& [name, bytes] : datasets) {
        if (bytes.empty() || name.starts_with("parameters")) continue;
        const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
        H5Ldelete(file, name.c_str(), H5P_DEFAULT);
        copy_dataset(dataset, bytes, file, name, form);
        H5Dclose(dataset);
    }
    H5Fclose(file);
}

/// Flips bits of one 8-byte element of a dataset.
inline void flip_element(const std::filesystem::path& path, const char* dataset,
                         const std::vector<hsize_t>& at, std::uint64_t bits) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    const hid_t data = H5Dopen2(file, dataset, H5P_DEFAULT), space = H5Dget_space(data);
    const std::vector<hsize_t> one(at.size(), 1);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, at.data(), nullptr, one.data(), nullptr);
    const hid_t memory = H5Screate_simple(1, one.data(), nullptr);
    const hid_t type = H5Dget_type(data);
    std::uint64_t value = 0;
    H5Dread(data, type, memory, space, H5P_DEFAULT, &value);
    value ^= bits;
    H5Dwrite(data, type, memory, space, H5P_DEFAULT, &value);
    H5Tclose(type);
    for (hid_t id : {memory, space}) H5Sclose(id);
    H5Dclose(data);
    H5Fclose(file);
}

/// An image of two float channels and one of ids.
struct WrittenImage {
    Imath::Box2i window{{2, -1}, {20, 12}};  ///< 19 x 14 pixels
    std::map<std::string, std::vector<float>> floats{{"R", ramp(1)}, {"Z", ramp(2)}};
    std::vector<std::uint32_t> ids = std::vector<std::uint32_t>(19 * 14, 7);

    static std::vector<float> ramp(float scale) {
        std::vector<float> values;
        for (int i = 0; i < 19 * 14; ++i) values.push_back(scale * static_cast<float>(i) / 16);
        return values;
    }
    static std::size_t index(int x, int y) {
        return static_cast<std::size_t>((y + 1) * 19 + x - 2);
    }

    /// @param tile   side of the tiles; 0: by lines
    void write(const std::filesystem::path& path, int tile = 8,
               Imf::Compression compression = Imf::ZIP_COMPRESSION,
               const std::string& note = "") const {
        Imf::Header header(Imath::Box2i({0, 0}, {99 + tile, 99}), window);
        header.compression() = compression;
        if (!note.empty()) header.insert("note", Imf::StringAttribute(note));
        Imf::FrameBuffer buffer;
        for (const auto& [name, values] : floats) {
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), window));
        }
        header.channels().insert("id", Imf::Channel(Imf::UINT));
        buffer.insert("id", Imf::Slice::Make(Imf::UINT, ids.data(), window));
        if (tile > 0) {
            const auto side = static_cast<unsigned>(tile);
            header.setTileDescription(Imf::TileDescription(side, side, Imf::ONE_LEVEL));
            header.lineOrder() = Imf::RANDOM_Y;
            Imf::TiledOutputFile out(path.c_str(), header, 0);
            out.setFrameBuffer(buffer);
            out.writeTiles(0, out.numXTiles() - 1, 0, out.numYTiles() - 1);
        } else {
            Imf::OutputFile out(path.c_str(), header, 0);
            out.setFrameBuffer(buffer);
            out.writePixels(window.max.y - window.min.y + 1);
        }
    }
};

}  // namespace tesserae::scenes::testing
