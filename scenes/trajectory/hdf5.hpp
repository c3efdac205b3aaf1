// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

// A thin layer over HDF5's C interface: every status is checked, every handle closed.
namespace tesserae::scenes::hdf5 {

/// A call failed; what() is HDF5's innermost reason. The caller adds the file's path.
struct Failure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The system refused (disk, memory, rights, descriptors): it says nothing about the file's
/// content.
struct SystemFailure : Failure {
    using Failure::Failure;
};

/// The result of a call that is negative if it failed. @throws Failure
template <class Result>
Result checked(Result result);

/// Owns an HDF5 identifier.
class Handle {
  public:
    using Close = herr_t (*)(hid_t);
    Handle() = default;
    /// @throws Failure   the identifier is that of a failed call
    Handle(hid_t id, Close how);
    Handle(Handle&& other) noexcept
        : id_(std::exchange(other.id_, -1)), close_(std::exchange(other.close_, nullptr)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    /// Closes now. @throws Failure
    void close();
    hid_t get() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

  private:
    hid_t id_ = -1;
    Close close_ = nullptr;
};

using Extent = std::vector<hsize_t>;

/// Opens without locks of HDF5's own (HDF5_USE_FILE_LOCKING=TRUE adds its lock to readers only);
/// starts the library on the first call: errors are not printed, and nothing is written when the
/// program exits. Files that are written go through ordered_driver().
Handle create_file(const std::filesystem::path& path);
Handle open_file(const std::filesystem::path& path, bool writable);

/// Objects carry no times: equal content is equal bytes.
Handle create_group(hid_t parent, const std::string& name);
/// A group that nothing leads to yet.
Handle create_unnamed_group(hid_t file);
/// Gives an object the name of another, whose name it was; from then on a file has the new one.
void replace_link(hid_t parent, const std::string& name, const Handle& object);
/// Follow hard links only. @throws Failure
Handle open_group(hid_t parent, const std::string& name);
Handle open_dataset(hid_t parent, const std::string& name);
/// A group, dataset or committed type.
Handle open_object(hid_t parent, const std::string& name);
/// Names of a group's links, ascending. @throws Failure   more than `most`, or one of more than 255
/// bytes
std::vector<std::string> link_names(const Handle& group, std::uint64_t most);
bool has_link(hid_t parent, const std::string& name);
void remove_link(hid_t parent, const std::string& name);
void hard_link(hid_t parent, const std::string& from, const std::string& to);

/// A text of so many bytes, at least one: UTF-8, filled up with zeros.
Handle text_type(std::size_t bytes);

/// A dataset that grows along its first axis, in chunks of the given extent. `compressed`: shuffle
/// and gzip. Nothing leads to it yet if the name is empty.
Handle create_growing(hid_t parent, const std::string& name, hid_t type, const Extent& extent,
                      const Extent& chunk, bool compressed);
/// A fixed text as a scalar dataset of that length.
void create_text(hid_t parent, const std::string& name, const std::string& text);
std::string read_text(hid_t parent, const std::string& name, std::uint64_t most_bytes);

void add_text_attribute(hid_t object, const std::string& name, const std::string& text);
void add_attribute(hid_t object, const std::string& name, hid_t file_type, hid_t memory_type,
                   const Extent& extent, const void* values);
bool has_attribute(hid_t object, const std::string& name);
/// A scalar. @throws Failure   missing, or not a number
void read_attribute(hid_t object, const std::string& name, hid_t memory_type, void* value);

std::string read_text_attribute(hid_t object, const std::string& name);

Extent extent_of(const Handle& dataset);
/// Bytes that a dataset takes in its file. @throws Failure   they cannot be counted
std::uint64_t storage_size(const Handle& dataset);
/// Items begin <= i < begin + count along the first axis, all along the others; at least one.
void read_rows(const Handle& dataset, std::uint64_t begin, std::uint64_t count, hid_t memory_type,
               void* values);
/// The item of that index along the second axis, of one row.
void read_item(const Handle& dataset, std::uint64_t row, std::uint64_t item, hid_t memory_type,
               void* values);
void write_rows(const Handle& dataset, std::uint64_t begin, std::uint64_t count, hid_t memory_type,
                const void* values);
/// Sets the first extent, if it is not that.
void resize(const Handle& dataset, std::uint64_t rows);

}  // namespace tesserae::scenes::hdf5
