// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/dataset_storage.hpp"

#include <algorithm>

namespace tesserae::scenes {
namespace {

using hdf5::checked;
using hdf5::Handle;

bool is_known_filter(hid_t creation, unsigned number) {
    std::size_t none = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(creation, number, nullptr, &none, nullptr, 0, nullptr, nullptr);
    return filter == H5Z_FILTER_SHUFFLE || filter == H5Z_FILTER_DEFLATE ||
           filter == H5Z_FILTER_FLETCHER32;
}

}  // namespace

DatasetStorage checked_storage(const Handle& dataset, const std::string& name,
                               std::uint64_t file_bytes) {
    const auto require = [&](bool good, const char* what) {
        if (!good) throw hdf5::Failure(name + ": " + what);
    };
    const Handle creation(H5Dget_create_plist(dataset.get()), H5Pclose);
    const H5D_layout_t layout = H5Pget_layout(creation.get());
    require(layout == H5D_CHUNKED || layout == H5D_CONTIGUOUS || layout == H5D_COMPACT,
            "is not stored in chunks or in one piece");
    require(checked(H5Pget_external_count(creation.get())) == 0, "is stored in another file");
    const int filters = checked(H5Pget_nfilters(creation.get()));
    for (unsigned i = 0; i < static_cast<unsigned>(filters); ++i)
        require(is_known_filter(creation.get(), i), "uses an unknown filter");

    DatasetStorage storage;
    storage.extent = hdf5::extent_of(dataset);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose);
    storage.bytes = static_cast<double>(H5Tget_size(type.get()));
    double chunk_bytes = storage.bytes, compression = 1;
    if (layout == H5D_CHUNKED) {
        compression = static_cast<double>(kMostCompression);
        storage.chunk.resize(storage.extent.size());
        const int axes = checked(H5Pget_chunk(
            creation.get(), static_cast<int>(storage.chunk.size()), storage.chunk.data()));
        // HDF5 itself does not compare them, and looks for chunks without end.
        require(static_cast<std::size_t>(axes) == storage.extent.size(),
                "has chunks of another number of axes");
        for (hsize_t side : storage.chunk) chunk_bytes *= static_cast<double>(side);
        require(chunk_bytes <= 256.0 * (1 << 20), "has chunks of more than 256 MiB");
    }
    for (hsize_t side : storage.extent) storage.bytes *= static_cast<double>(side);
    const double stored = static_cast<double>(std::min(hdf5::storage_size(dataset), file_bytes));
    require(storage.bytes <= compression * stored, "claims to hold more than the file can");
    return storage;
}

}  // namespace tesserae::scenes
