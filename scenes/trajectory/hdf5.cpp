// SPDX-License-Identifier: Apache-2.0
#include "scenes/trajectory/hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenes/trajectory/trajectory_driver.hpp"

namespace tesserae::scenes::hdf5 {
namespace {

/// gzip's level, usual 1: on 10^4 bodies in free flight level 4 saves 1 % and takes longer.
constexpr unsigned kDeflateLevel = 1;
/// Bytes of a name in a file that is listed: bounds what a damaged one makes of memory.
constexpr std::size_t kLongestName = 255;

/// Throws the innermost entry of HDF5's error stack; of a failed system call the system's words.
[[noreturn]] void throw_reason() {
    std::string text;
    const auto keep = [](unsigned, const H5E_error2_t* entry, void* to) -> herr_t {
        *static_cast<std::string*>(to) = entry->desc ? entry->desc : "";
        return 0;
    };
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep, &text);
    H5Eclear2(H5E_DEFAULT);
    constexpr std::string_view kSystem = "error message = '";
    if (const std::size_t begin = text.find(kSystem); begin != std::string::npos) {
        text.erase(0, begin + kSystem.size());
        text.erase(std::min(text.find('\''), text.size()));
        throw SystemFailure(text);
    }
    throw Failure(text.empty() ? "HDF5 gives no reason" : text);
}

Handle property_list(hid_t of) { return {H5Pcreate(of), H5Pclose}; }

Handle dataspace(const Extent& extent) {
    if (extent.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
    return {H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr), H5Sclose};
}

/// How files are opened: shared by creating and opening.
Handle file_access(bool writable) {
    static const bool started = [] {
        // After a failed write HDF5 would try again while the program exits.
        checked(H5dont_atexit());
        checked(H5open());
        checked(H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr));
        return true;
    }();
    static_cast<void>(started);
    Handle access = property_list(H5P_FILE_ACCESS);
    checked(H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG));
    // Writers hold a lock of their own, from before HDF5 opens the file until it has its name.
    checked(H5Pset_file_locking(access.get(), false, true));
    checked(H5Pset_driver(access.get(), checked(ordered_driver()), nullptr));
    if (!writable) return access;
    // Structures leave memory only while the file is flushed.
    H5AC_cache_config_t cache;
    cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
    checked(H5Pget_mdc_config(access.get(), &cache));
    cache.evictions_enabled = false;
    cache.incr_mode = H5C_incr__off;
    cache.flash_incr_mode = H5C_flash_incr__off;
    cache.decr_mode = H5C_decr__off;
    checked(H5Pset_mdc_config(access.get(), &cache));
    return access;
}

/// A link of another kind leads to other places, even to other files.
void require_hard_links(hid_t parent, const std::string& path) {
    for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
        const std::string part = path.substr(0, end);
        H5L_info_t info;
        checked(H5Lget_info(parent, part.c_str(), &info, H5P_DEFAULT));
        if (info.type != H5L_TYPE_HARD) throw Failure(part + ": is a link to another place");
        if (end == std::string::npos) return;
    }
}

struct Selection {
    Handle memory, file;
};

/// @param begin, count   along the first axes; all along the others
Selection select(const Handle& dataset, const Extent& begin, const Extent& count) {
    Extent extent = extent_of(dataset);
    Extent start(extent.size(), 0);
    if (extent.size() < begin.size()) throw Failure("a dataset of too few axes");
    for (std::size_t axis = 0; axis < begin.size(); ++axis) {
        if (begin[axis] + count[axis] > extent[axis])
            throw Failure("rows beyond the dataset's end");
        start[axis] = begin[axis];
        extent[axis] = count[axis];
    }
    Selection selection{dataspace(extent), {H5Dget_space(dataset.get()), H5Sclose}};
    checked(H5Sselect_hyperslab(selection.file.get(), H5S_SELECT_SET, start.data(), nullptr,
                                extent.data(), nullptr));
    return selection;
}

Selection select_rows(const Handle& dataset, std::uint64_t begin, std::uint64_t count) {
    return select(dataset, {begin}, {count});
}

}  // namespace

template <class Result>
Result checked(Result result) {
    if (result < 0) throw_reason();
    return result;
}
template herr_t checked(herr_t);
template hid_t checked(hid_t);
template H5T_class_t checked(H5T_class_t);

Handle::Handle(hid_t id, Close how) : id_(checked(id)), close_(how) {}

void Handle::close() {
    const hid_t id = std::exchange(id_, -1);
    checked(close_(id));
}

Handle create_file(const std::filesystem::path& path) {
    const Handle access = file_access(true);
    const Handle creation = property_list(H5P_FILE_CREATE);
    checked(H5Pset_obj_track_times(creation.get(), false));
    return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose};
}

Handle open_file(const std::filesystem::path& path, bool writable) {
    const Handle access = file_access(writable);
    const unsigned mode = writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY;
    return {H5Fopen(path.c_str(), mode, access.get()), H5Fclose};
}

Handle create_group(hid_t parent, const std::string& name) {
    const Handle creation = property_list(H5P_GROUP_CREATE);
    checked(H5Pset_obj_track_times(creation.get(), false));
    return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT), H5Gclose};
}

Handle create_unnamed_group(hid_t file) {
    const Handle creation = property_list(H5P_GROUP_CREATE);
    checked(H5Pset_obj_track_times(creation.get(), false));
    return {H5Gcreate_anon(file, creation.get(), H5P_DEFAULT), H5Gclose};
}

void replace_link(hid_t parent, const std::string& name, const Handle& object) {
    remove_link(parent, name);
    checked(H5Olink(object.get(), parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
}

Handle open_group(hid_t parent, const std::string& name) {
    require_hard_links(parent, name);
    return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose};
}

Handle open_dataset(hid_t parent, const std::string& name) {
    require_hard_links(parent, name);
    return {H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose};
}

Handle open_object(hid_t parent, const std::string& name) {
    require_hard_links(parent, name);
    return {H5Oopen(parent, name.c_str(), H5P_DEFAULT), H5Oclose};
}

std::vector<std::string> link_names(const Handle& group, std::uint64_t most) {
    H5G_info_t info;
    checked(H5Gget_info(group.get(), &info));
    if (info.nlinks > most) throw Failure(fmt::format("a group holds more than {} objects", most));
    std::vector<std::string> names;
    for (hsize_t i = 0; i < info.nlinks; ++i) {
        char name[kLongestName + 1] = {};
        const auto bytes = checked<hid_t>(H5Lget_name_by_idx(
            group.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name, H5P_DEFAULT));
        if (bytes > hid_t{kLongestName})
            throw Failure(fmt::format("a name is longer than {} bytes", kLongestName));
        names.emplace_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

bool has_link(hid_t parent, const std::string& name) {
    return checked(H5Lexists(parent, name.c_str(), H5P_DEFAULT)) > 0;
}

void remove_link(hid_t parent, const std::string& name) {
    checked(H5Ldelete(parent, name.c_str(), H5P_DEFAULT));
}

void hard_link(hid_t parent, const std::string& from, const std::string& to) {
    checked(H5Lcreate_hard(parent, from.c_str(), parent, to.c_str(), H5P_DEFAULT, H5P_DEFAULT));
}

Handle text_type(std::size_t bytes) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    checked(H5Tset_size(type.get(), std::max<std::size_t>(bytes, 1)));
    checked(H5Tset_strpad(type.get(), H5T_STR_NULLPAD));
    checked(H5Tset_cset(type.get(), H5T_CSET_UTF8));
    return type;
}

Handle create_growing(hid_t parent, const std::string& name, hid_t type, const Extent& extent,
                      const Extent& chunk, bool compressed) {
    // A fixed axis of length 0 would be shorter than its chunk.
    Extent most = extent;
    for (hsize_t& side : most) side = std::max<hsize_t>(side, 1);
    most[0] = H5S_UNLIMITED;
    const auto rank = static_cast<int>(extent.size());
    const Handle space(H5Screate_simple(rank, extent.data(), most.data()), H5Sclose);
    const Handle creation = property_list(H5P_DATASET_CREATE);
    checked(H5Pset_obj_track_times(creation.get(), false));
    checked(H5Pset_chunk(creation.get(), rank, chunk.data()));
    if (compressed) {
        checked(H5Pset_shuffle(creation.get()));
        checked(H5Pset_deflate(creation.get(), kDeflateLevel));
    }
    if (name.empty())
        return {H5Dcreate_anon(parent, type, space.get(), creation.get(), H5P_DEFAULT), H5Dclose};
    return {H5Dcreate2(parent, name.c_str(), type, space.get(), H5P_DEFAULT, creation.get(),
                       H5P_DEFAULT),
            H5Dclose};
}

void create_text(hid_t parent, const std::string& name, const std::string& text) {
    const Handle type = text_type(text.size());
    const Handle space = dataspace({});
    const Handle creation = property_list(H5P_DATASET_CREATE);
    checked(H5Pset_obj_track_times(creation.get(), false));
    Handle dataset(H5Dcreate2(parent, name.c_str(), type.get(), space.get(), H5P_DEFAULT,
                              creation.get(), H5P_DEFAULT),
                   H5Dclose);
    checked(H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
    dataset.close();
}

std::string read_text(hid_t parent, const std::string& name, std::uint64_t most_bytes) {
    const Handle dataset = open_dataset(parent, name);
    const Handle type(H5Dget_type(dataset.get()), H5Tclose);
    if (checked(H5Tget_class(type.get())) != H5T_STRING ||
        checked(H5Tis_variable_str(type.get())) > 0 || !extent_of(dataset).empty())
        throw Failure(name + ": is not a text of fixed length");
    const Handle creation(H5Dget_create_plist(dataset.get()), H5Pclose);
    if (H5Pget_layout(creation.get()) != H5D_CONTIGUOUS ||
        H5Pget_external_count(creation.get()) != 0)
        throw Failure(name + ": is not stored in one piece of this file");
    const std::size_t bytes = H5Tget_size(type.get());
    if (bytes > most_bytes) throw Failure(name + ": is longer than the file");
    const Handle memory = text_type(bytes);
    std::string text(bytes, '\0');
    checked(H5Dread(dataset.get(), memory.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()));
    text.erase(text.find_last_not_of('\0') + 1);
    return text;
}

void add_text_attribute(hid_t object, const std::string& name, const std::string& text) {
    const Handle type = text_type(text.size());
    add_attribute(object, name, type.get(), type.get(), {}, text.data());
}

void add_attribute(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type,
                   const Extent& extent, const void* values) {
    const Handle space = dataspace(extent);
    Handle attribute(
        H5Acreate2(object, name.c_str(), file_type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    checked(H5Awrite(attribute.get(), memory_type, values));
    attribute.close();
}

bool has_attribute(hid_t object, const std::string& name) {
    return checked(H5Aexists(object, name.c_str())) > 0;
}

void read_attribute(hid_t object, const std::string& name, hid_t memory_type, void* value) {
    const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
    const Handle space(H5Aget_space(attribute.get()), H5Sclose);
    const Handle type(H5Aget_type(attribute.get()), H5Tclose);
    const H5T_class_t kind = H5Tget_class(type.get());
    if (H5Sget_simple_extent_npoints(space.get()) != 1 ||
        (kind != H5T_INTEGER && kind != H5T_FLOAT))
        throw Failure(name + ": is not a number");
    checked(H5Aread(attribute.get(), memory_type, value));
}

std::string read_text_attribute(hid_t object, const std::string& name) {
    const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose);
    const Handle space(H5Aget_space(attribute.get()), H5Sclose);
    const Handle type(H5Aget_type(attribute.get()), H5Tclose);
    if (H5Sget_simple_extent_npoints(space.get()) != 1 || H5Tget_class(type.get()) != H5T_STRING ||
        H5Tis_variable_str(type.get()) > 0)
        throw Failure(name + ": is not a text of fixed length");
    const std::size_t bytes = H5Tget_size(type.get());
    // Attributes lie in an object's header, which has no room for more.
    if (bytes > 64 * 1024) throw Failure(name + ": is too long");
    std::string text(bytes, '\0');
    checked(H5Aread(attribute.get(), text_type(bytes).get(), text.data()));
    text.erase(text.find_last_not_of('\0') + 1);
    return text;
}

Extent extent_of(const Handle& dataset) {
    const Handle space(H5Dget_space(dataset.get()), H5Sclose);
    Extent extent(static_cast<std::size_t>(checked(H5Sget_simple_extent_ndims(space.get()))));
    checked(H5Sget_simple_extent_dims(space.get(), extent.data(), nullptr));
    return extent;
}

std::uint64_t storage_size(const Handle& dataset) {
    // A dataset without storage and a failure are both 0; only the second leaves a reason.
    H5Eclear2(H5E_DEFAULT);
    const hsize_t bytes = H5Dget_storage_size(dataset.get());
    if (bytes == 0 && H5Eget_num(H5E_DEFAULT) > 0) throw_reason();
    return bytes;
}

void read_rows(const Handle& dataset, std::uint64_t begin, std::uint64_t count, hid_t memory_type,
               void* values) {
    const Selection rows = select_rows(dataset, begin, count);
    checked(H5Dread(dataset.get(), memory_type, rows.memory.get(), rows.file.get(), H5P_DEFAULT,
                    values));
}

void read_item(const Handle& dataset, std::uint64_t row, std::uint64_t item, hid_t memory_type,
               void* values) {
    const Selection one = select(dataset, {row, item}, {1, 1});
    checked(
        H5Dread(dataset.get(), memory_type, one.memory.get(), one.file.get(), H5P_DEFAULT, values));
}

void write_rows(const Handle& dataset, std::uint64_t begin, std::uint64_t count, hid_t memory_type,
                const void* values) {
    const Selection rows = select_rows(dataset, begin, count);
    checked(H5Dwrite(dataset.get(), memory_type, rows.memory.get(), rows.file.get(), H5P_DEFAULT,
                     values));
}

void resize(const Handle& dataset, std::uint64_t rows) {
    Extent extent = extent_of(dataset);
    if (std::exchange(extent[0], rows) == rows) return;
    checked(H5Dset_extent(dataset.get(), extent.data()));
}

}  // namespace tesserae::scenes::hdf5
