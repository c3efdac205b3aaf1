// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "scenes/trajectory/hdf5.hpp"
#include "scenes/trajectory/trajectory.hpp"

namespace tesserae::scenes {

/// The bytes of every dataset of a trajectory and the names of all objects, through HDF5's own
/// interface.
inline std::map<std::string, std::string> datasets_of(const std::filesystem::path& path) {
    // Starts HDF5 the way the program needs it, which has to be before its first use.
    static_cast<void>(TrajectoryReader(path));
    std::map<std::string, std::string> found;
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    const auto visit = [](hid_t root, const char* name, const H5L_info_t*, void* to) -> herr_t {
        auto& all = *static_cast<std::map<std::string, std::string>*>(to);
        const hid_t object = H5Oopen(root, name, H5P_DEFAULT);
        std::string& bytes = all[name];
        if (H5Iget_type(object) == H5I_DATASET) {
            const hid_t type = H5Dget_type(object), space = H5Dget_space(object);
            const auto points = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
            bytes.resize(points * H5Tget_size(type));
            if (H5Dread(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) < 0)
                bytes = "unreadable";
            H5Tclose(type);
            H5Sclose(space);
        }
        H5Oclose(object);
        return 0;
    };
    H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, visit, &found);
    H5Fclose(file);
    return found;
}

/// A dataset of the extents, chunked where `chunk` is not 0, empty.
inline void make_dataset(hid_t file, const char* name, hid_t type, std::vector<hsize_t> extent,
                         hsize_t chunk) {
    const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    if (chunk > 0) {
        std::vector<hsize_t> sides(extent.size(), 1);
        sides[0] = chunk;
        H5Pset_chunk(creation, static_cast<int>(sides.size()), sides.data());
    }
    H5Dclose(H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Pclose(creation);
    H5Sclose(space);
}

inline void make_text(hid_t file, const char* name, std::size_t bytes) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, bytes);
    H5Dclose(H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
    H5Tclose(type);
}

/// The texts of a dataset of fixed length, one a body. The file may be one that is being written.
inline std::vector<std::string> texts_of(const std::filesystem::path& path, const char* name) {
    const hdf5::Handle file = hdf5::open_file(path, false);
    const hdf5::Handle dataset = hdf5::open_dataset(file.get(), name);
    const hdf5::Handle type(H5Dget_type(dataset.get()), H5Tclose);
    if (H5Tget_class(type.get()) != H5T_STRING || H5Tget_strpad(type.get()) != H5T_STR_NULLPAD ||
        H5Tget_cset(type.get()) != H5T_CSET_UTF8)
        return {};
    const std::size_t bytes = H5Tget_size(type.get());
    const std::uint64_t bodies = hdf5::extent_of(dataset)[0];
    std::string all(bodies * bytes, '?');
    if (bodies > 0) hdf5::read_rows(dataset, 0, bodies, type.get(), all.data());
    std::vector<std::string> texts;
    for (std::size_t at = 0; at < all.size(); at += bytes) {
        const std::string text = all.substr(at, bytes);
        texts.push_back(text.substr(0, text.find('\0')));
    }
    return texts;
}

/// The names of the datasets that differ, or that only one of two files has; empty if none.
inline std::string different_datasets(const std::filesystem::path& a,
                                      const std::filesystem::path& b) {
    const auto in_a = datasets_of(a), in_b = datasets_of(b);
    std::string names;
    for (const auto& [name, bytes] : in_a)
        if (!in_b.contains(name) || in_b.at(name) != bytes) names += name + " ";
    for (const auto& [name, bytes] : in_b)
        if (!in_a.contains(name)) names += name + " ";
    return in_a.empty() ? a.string() + " has none" : names;
}

}  // namespace tesserae::scenes
