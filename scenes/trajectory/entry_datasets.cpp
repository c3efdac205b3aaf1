// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/entry_datasets.hpp"

#include "scenes/trajectory/dataset_storage.hpp"

namespace tesserae::scenes {
namespace {

using hdf5::checked;
using hdf5::Handle;

/// Opens a dataset of so many entries of a class of types.
Handle open_entries(hid_t group, const std::string& name, const std::string& path,
                    std::uint64_t entries, std::uint64_t file_bytes, H5T_class_t of) {
    const auto require = [&](bool good, const char* what) {
        if (!good) throw hdf5::Failure(path + "/" + name + ": " + what);
    };
    Handle dataset = hdf5::open_dataset(group, name);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose);
    const bool is_text = of == H5T_STRING;
    require(H5Tget_class(type.get()) == of &&
                (!is_text || checked(H5Tis_variable_str(type.get())) == 0),
            is_text ? "is not of texts of a fixed length" : "is not of reals");
    const DatasetStorage storage = checked_storage(dataset, path + "/" + name, file_bytes);
    require(storage.extent.size() == 1 && storage.extent[0] == entries, "has another shape");
    return dataset;
}

}  // namespace

std::vector<std::string> read_texts(hid_t group, const std::string& name, const std::string& path,
                                    std::uint64_t entries, std::uint64_t file_bytes) {
    const Handle dataset = open_entries(group, name, path, entries, file_bytes, H5T_STRING);
    std::vector<std::string> texts(entries);
    if (entries == 0) return texts;
    const Handle type(H5Dget_type(dataset.get()), H5Tclose);
    const std::size_t width = H5Tget_size(type.get());
    std::string all(entries * width, '\0');
    hdf5::read_rows(dataset, 0, entries, type.get(), all.data());
    for (std::size_t i = 0; i < texts.size(); ++i) {
        const std::string entry = all.substr(i * width, width);
        texts[i] = entry.substr(0, entry.find('\0'));
    }
    return texts;
}

std::vector<double> read_reals(hid_t group, const std::string& name, const std::string& path,
                               std::uint64_t entries, std::uint64_t file_bytes) {
    const Handle dataset = open_entries(group, name, path, entries, file_bytes, H5T_FLOAT);
    std::vector<double> values(entries);
    if (entries > 0) hdf5::read_rows(dataset, 0, entries, H5T_NATIVE_DOUBLE, values.data());
    return values;
}

}  // namespace tesserae::scenes
