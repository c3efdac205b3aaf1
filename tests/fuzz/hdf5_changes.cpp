// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/hdf5_changes.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tesserae::fuzz {
namespace {

using scenes::hdf5::checked;
using scenes::hdf5::Extent;
using scenes::hdf5::Failure;
using scenes::hdf5::Handle;

/// What is written into a dataset, and read from one to be changed, is no longer.
constexpr std::size_t kMostBytes = 1 << 16;

constexpr hsize_t kSides[] = {0,       1,          2,          3,
                              4,       5,          6,          8,
                              13,      1000,       65'537,     10'000'001,
                              1 << 28, 1ull << 32, 1ull << 40, std::numeric_limits<hsize_t>::max()};

hsize_t any_side(FuzzedDataProvider& input) { return input.PickValueInArray(kSides); }

Handle in_memory(const std::string& bytes) {
    // Starts the library as the project does.
    static const Handle file_access = [] {
        try {
            scenes::hdf5::open_file("/nonexistent", false);
        } catch (const Failure&) {
        }
        return Handle(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    }();
    const Handle access(H5Pcopy(file_access.get()), H5Pclose);
    checked(H5Pset_fapl_core(access.get(), kMostBytes, false));
    checked(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG));
    checked(H5Pset_file_image(access.get(), const_cast<char*>(bytes.data()), bytes.size()));
    return {H5Fopen("changed.h5", H5F_ACC_RDWR, access.get()), H5Fclose};
}

Handle copy_of(hid_t type) { return {H5Tcopy(type), H5Tclose}; }

Handle text_type(FuzzedDataProvider& input) {
    Handle type = copy_of(H5T_C_S1);
    constexpr std::size_t kSizes[] = {1, 2, 8, 64, 300, 65'000, 1 << 20, std::size_t{1} << 31};
    checked(H5Tset_size(type.get(), input.ConsumeIntegralInRange(0, 8) == 0
                                        ? H5T_VARIABLE
                                        : input.PickValueInArray(kSizes)));
    const H5T_str_t paddings[] = {H5T_STR_NULLTERM, H5T_STR_NULLPAD, H5T_STR_SPACEPAD};
    checked(H5Tset_strpad(type.get(), paddings[input.ConsumeIntegralInRange(0, 2)]));
    return type;
}

/// A number of fewer bits than it has room for, or a real of other parts.
Handle odd_number(FuzzedDataProvider& input) {
    if (input.ConsumeBool()) {
        Handle type = copy_of(H5T_STD_I64LE);
        checked(H5Tset_precision(type.get(), input.ConsumeIntegralInRange<std::size_t>(1, 64)));
        checked(H5Tset_offset(type.get(), input.ConsumeIntegralInRange<std::size_t>(0, 63)));
        return type;
    }
    Handle type = copy_of(H5T_IEEE_F64LE);
    const auto exponent = input.ConsumeIntegralInRange<std::size_t>(1, 60);
    checked(H5Tset_fields(type.get(), 63, 63 - exponent, exponent, 0, 63 - exponent));
    checked(H5Tset_ebias(type.get(), input.ConsumeIntegral<std::uint16_t>()));
    return type;
}

Handle any_type(FuzzedDataProvider& input) {
    const hid_t numbers[] = {H5T_IEEE_F64LE, H5T_IEEE_F64BE, H5T_IEEE_F32LE, H5T_STD_I64LE,
                             H5T_STD_I64BE,  H5T_STD_U64LE,  H5T_STD_I32LE,  H5T_STD_U32BE,
                             H5T_STD_I16LE,  H5T_STD_U8LE,   H5T_STD_B64LE,  H5T_STD_REF_OBJ};
    const auto number = [&] { return numbers[input.ConsumeIntegralInRange<std::size_t>(0, 11)]; };
    switch (input.ConsumeIntegralInRange(0, 9)) {
        case 0:
        case 1:
            return text_type(input);
        case 2:
            return odd_number(input);
        case 3: {
            Handle type(H5Tcreate(H5T_COMPOUND, 16), H5Tclose);
            checked(H5Tinsert(type.get(), "a", 0, H5T_IEEE_F64LE));
            checked(H5Tinsert(type.get(), "b", 8, H5T_STD_I32LE));
            return type;
        }
        case 4: {
            const hsize_t sides[] = {any_side(input), 2};
            return {H5Tarray_create2(number(), 2, sides), H5Tclose};
        }
        case 5:
            return {H5Tvlen_create(number()), H5Tclose};
        case 6: {
            Handle type(H5Tenum_create(H5T_STD_I64LE), H5Tclose);
            const std::int64_t value = 3;
            checked(H5Tenum_insert(type.get(), "three", &value));
            return type;
        }
        default:
            return copy_of(number());
    }
}

Handle any_space(FuzzedDataProvider& input, Extent& extent) {
    const int rank = input.ConsumeIntegralInRange(-1, 4);
    if (rank < 1) return {H5Screate(rank < 0 ? H5S_NULL : H5S_SCALAR), H5Sclose};
    for (int i = 0; i < rank; ++i) extent.push_back(any_side(input));
    Extent most = extent;
    if (input.ConsumeBool()) most[0] = H5S_UNLIMITED;
    return {H5Screate_simple(rank, extent.data(), most.data()), H5Sclose};
}

/// How a dataset of this space is stored. Chunks are written whole, whatever the dataset has of
/// them, so their sides are at most four of its own.
Handle any_storage(FuzzedDataProvider& input, const Handle& space) {
    Extent sides(std::max(H5Sget_simple_extent_ndims(space.get()), 0));
    if (!sides.empty()) H5Sget_simple_extent_dims(space.get(), sides.data(), nullptr);
    Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const hid_t c = creation.get();
    switch (input.ConsumeIntegralInRange(0, 9)) {
        case 0:
            checked(H5Pset_layout(c, H5D_COMPACT));
            break;
        case 1:
            checked(H5Pset_external(c, "/proc/self/environ", 0, 4096));
            break;
        case 2:
        case 3:
            break;
        default: {
            if (sides.empty()) break;
            for (hsize_t& side : sides)
                side = std::clamp<hsize_t>(any_side(input), 1,
                                           4 * std::clamp<hsize_t>(side, 1, 1 << 18));
            checked(H5Pset_chunk(c, static_cast<int>(sides.size()), sides.data()));
            const auto filters = input.ConsumeIntegral<std::uint8_t>();
            if (filters & 1) checked(H5Pset_shuffle(c));
            if (filters & 2) checked(H5Pset_deflate(c, 1));
            if (filters & 4) checked(H5Pset_fletcher32(c));
            // Not HDF5's own others, which it does not always survive as a writer.
            if (filters & 8) checked(H5Pset_filter(c, 305, H5Z_FLAG_OPTIONAL, 0, nullptr));
        }
    }
    return creation;
}

void remove(hid_t file, const std::string& path) {
    if (H5Lexists(file, path.c_str(), H5P_DEFAULT) > 0)
        checked(H5Ldelete(file, path.c_str(), H5P_DEFAULT));
}

/// As many bytes as asked for, those of the input again and again.
std::string filled(FuzzedDataProvider& input, std::size_t bytes) {
    std::string piece =
        input.ConsumeRandomLengthString(std::min<std::size_t>(bytes, 256)) + std::string(1, '\0');
    std::string all;
    while (all.size() < bytes) all += piece;
    return all;
}

std::size_t bytes_of(const Handle& dataset) {
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose);
    const double points = static_cast<double>(H5Sget_simple_extent_npoints(space.get()));
    const double bytes = points * static_cast<double>(H5Tget_size(type.get()));
    return bytes >= 0 && bytes <= kMostBytes ? static_cast<std::size_t>(bytes) : kMostBytes + 1;
}

/// Values of variable length are pointers in memory.
bool has_pointers(const Handle& type) {
    return H5Tdetect_class(type.get(), H5T_VLEN) > 0 || H5Tis_variable_str(type.get()) > 0;
}

/// A dataset of any kind in the place of what was there.
void put_dataset(hid_t file, const std::string& path, FuzzedDataProvider& input) {
    remove(file, path);
    const Handle type = any_type(input);
    Extent extent;
    const Handle space = any_space(input, extent);
    const Handle storage = any_storage(input, space);
    const Handle dataset(H5Dcreate2(file, path.c_str(), type.get(), space.get(), H5P_DEFAULT,
                                    storage.get(), H5P_DEFAULT),
                         H5Dclose);
    const H5T_class_t kind = H5Tget_class(type.get());
    const bool is_plain = kind == H5T_INTEGER || kind == H5T_FLOAT ||
                          (kind == H5T_STRING && H5Tis_variable_str(type.get()) == 0);
    const std::size_t bytes = bytes_of(dataset);
    if (!is_plain || bytes > kMostBytes || H5Pget_external_count(storage.get()) != 0) return;
    const std::string values = filled(input, bytes);
    checked(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

/// The same values in another form: their order of bytes, their layout.
void store_otherwise(hid_t file, const std::string& path, FuzzedDataProvider& input) {
    Handle dataset = scenes::hdf5::open_dataset(file, path);
    const std::size_t bytes = bytes_of(dataset);
    const Handle old(H5Dget_type(dataset.get()), H5Tclose), type = copy_of(old.get());
    // HDF5 takes memory for a value that it converts, also where there is none.
    if (std::max(bytes, H5Tget_size(type.get())) > kMostBytes || has_pointers(type)) return;
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    std::string values(bytes + 1, '\0');
    checked(H5Dread(dataset.get(), old.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    if (H5Tget_class(type.get()) == H5T_STRING)
        checked(H5Tset_size(type.get(),
                            H5Tget_size(type.get()) + input.ConsumeIntegral<std::uint8_t>()));
    else if (input.ConsumeBool())
        checked(H5Tset_order(type.get(), H5T_ORDER_BE));
    const Handle storage = any_storage(input, space);
    remove(file, path);
    dataset = Handle(H5Dcreate2(file, path.c_str(), type.get(), space.get(), H5P_DEFAULT,
                                storage.get(), H5P_DEFAULT),
                     H5Dclose);
    if (H5Pget_external_count(storage.get()) != 0) return;
    checked(H5Dwrite(dataset.get(), old.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

/// Some other values.
void change_values(hid_t file, const std::string& path, FuzzedDataProvider& input) {
    const Handle dataset = scenes::hdf5::open_dataset(file, path);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose);
    const std::size_t bytes = bytes_of(dataset);
    if (bytes > kMostBytes || bytes == 0 || has_pointers(type)) return;
    std::string values(bytes, '\0');
    checked(H5Dread(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
    const double reals[] = {NAN, INFINITY, -1, 0, 5e-324, 1e300, 1e-200, 0.1};
    std::uint64_t bits = input.ConsumeIntegral<std::uint64_t>();
    if (input.ConsumeBool()) std::memcpy(&bits, &reals[bits % std::size(reals)], sizeof bits);
    const std::size_t at = input.ConsumeIntegralInRange<std::size_t>(0, bytes - 1) / 8 * 8;
    std::memcpy(values.data() + at, &bits, std::min<std::size_t>(8, bytes - at));
    checked(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
}

void put_attribute(hid_t file, const std::string& path, const std::string& name,
                   FuzzedDataProvider& input) {
    const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose);
    if (H5Aexists(object.get(), name.c_str()) > 0) checked(H5Adelete(object.get(), name.c_str()));
    if (input.ConsumeIntegralInRange(0, 7) == 0) return;
    const Handle type = any_type(input);
    Extent extent;
    const Handle space = any_space(input, extent);
    // As a writer HDF5 does not survive sizes that overflow.
    double size = static_cast<double>(H5Tget_size(type.get()));
    for (const hsize_t side : extent) size *= static_cast<double>(side);
    if (!(size < 0x1p62)) return;
    const Handle attribute(
        H5Acreate2(object.get(), name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    const H5T_class_t kind = H5Tget_class(type.get());
    const double bytes = static_cast<double>(H5Sget_simple_extent_npoints(space.get())) *
                         static_cast<double>(H5Tget_size(type.get()));
    if (kind != H5T_INTEGER && kind != H5T_FLOAT) return;
    if (!(bytes >= 0 && bytes <= kMostBytes)) return;
    const std::string values = filled(input, static_cast<std::size_t>(bytes));
    checked(H5Awrite(attribute.get(), type.get(), values.data()));
}

/// All paths below a group, and the names of all attributes.
void list(hid_t file, const std::string& group, std::vector<std::string>& paths,
          std::vector<std::string>& attributes) {
    const Handle object(H5Oopen(file, group.empty() ? "/" : group.c_str(), H5P_DEFAULT), H5Oclose);
    H5O_info_t info;
    checked(H5Oget_info2(object.get(), &info, H5O_INFO_NUM_ATTRS));
    for (hsize_t i = 0; i < info.num_attrs; ++i) {
        char name[64] = {};
        checked<hid_t>(H5Aget_name_by_idx(object.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name,
                                          sizeof name, H5P_DEFAULT));
        if (std::find(attributes.begin(), attributes.end(), name) == attributes.end())
            attributes.emplace_back(name);
    }
    if (H5Iget_type(object.get()) != H5I_GROUP) return;
    for (const std::string& name : scenes::hdf5::link_names(object, 1000)) {
        const std::string path = group + "/" + name;
        paths.push_back(path);
        list(file, path, paths, attributes);
    }
}

}  // namespace

Hdf5Changes::Hdf5Changes(std::string file, MoreChange more)
    : bytes_(std::move(file)), more_(std::move(more)) {
    const Handle opened = in_memory(bytes_);
    list(opened.get(), "", paths_, attributes_);
}

const std::string& Hdf5Changes::any_path(FuzzedDataProvider& input) const {
    return paths_[input.ConsumeIntegralInRange<std::size_t>(0, paths_.size() - 1)];
}

void Hdf5Changes::change(hid_t file, FuzzedDataProvider& input) const {
    const std::string& path = any_path(input);
    switch (input.ConsumeIntegralInRange(0, 15)) {
        case 0:
            return remove(file, path);
        case 1: {
            const std::string& to = any_path(input);
            remove(file, path);
            checked(H5Lcreate_soft(to.c_str(), file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT));
            return;
        }
        case 2:
            remove(file, path);
            checked(
                H5Lcreate_external("other.h5", "/", file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT));
            return;
        case 3: {
            // A group may so come to hold itself.
            const std::string to = path + input.ConsumeRandomLengthString(4);
            if (H5Lexists(file, to.c_str(), H5P_DEFAULT) > 0) remove(file, to);
            checked(H5Lcreate_hard(file, any_path(input).c_str(), file, to.c_str(), H5P_DEFAULT,
                                   H5P_DEFAULT));
            return;
        }
        case 4:
            remove(file, path);
            scenes::hdf5::create_group(file, path);
            return;
        case 5: {
            remove(file, path);
            const Handle type = any_type(input);
            checked(
                H5Tcommit2(file, path.c_str(), type.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
            return;
        }
        case 6:
            remove(file, path);
            return scenes::hdf5::create_text(file, path, input.ConsumeRandomLengthString(500));
        case 7:
        case 8:
            return put_dataset(file, path, input);
        case 9:
        case 10:
            return store_otherwise(file, path, input);
        case 11: {
            const Handle dataset = scenes::hdf5::open_dataset(file, path);
            if (scenes::hdf5::extent_of(dataset).empty()) return;
            return scenes::hdf5::resize(dataset, std::min<hsize_t>(any_side(input), 1 << 20));
        }
        case 12:
            return put_attribute(
                file, path,
                attributes_[input.ConsumeIntegralInRange<std::size_t>(0, attributes_.size() - 1)],
                input);
        case 13:
            if (more_) return more_(file, input);
            [[fallthrough]];
        default:
            return change_values(file, path, input);
    }
}

std::string Hdf5Changes::changed(FuzzedDataProvider& input) const {
    try {
        const Handle file = in_memory(bytes_);
        for (int i = 0; i < 8 && input.remaining_bytes() > 0; ++i) {
            try {
                change(file.get(), input);
            } catch (const Failure&) {
                // It was none that HDF5 makes.
            }
        }
        checked(H5Fflush(file.get(), H5F_SCOPE_GLOBAL));
        const auto size = checked<hid_t>(H5Fget_file_image(file.get(), nullptr, 0));
        std::string bytes(static_cast<std::size_t>(size), '\0');
        checked<hid_t>(H5Fget_file_image(file.get(), bytes.data(), bytes.size()));
        return bytes;
    } catch (const Failure&) {
        return {};
    }
}

}  // namespace tesserae::fuzz
