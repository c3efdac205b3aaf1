// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"

namespace tesserae {

/// A BusyError says that another process writes the same file.
struct BusyError : RunError {
    using RunError::RunError;
};

/// A PartialFile is the file PATH.partial, open for reading and writing. It is locked (flock)
/// against other processes until it gets its final name. A killed process leaves no lock, and its
/// leftover content is still there when the file is opened again. Failures throw RunError with the
/// path and the system's reason.
class PartialFile {
  public:
    /// Opens and locks the file.
    /// @throws RunError   it cannot be created; BusyError: another process holds it
    explicit PartialFile(std::filesystem::path path);
    /// Closes the file and leaves it where it is.
    ~PartialFile();
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;

    const std::filesystem::path& path() const { return path_; }
    const std::filesystem::path& partial() const { return partial_; }
    int descriptor() const { return descriptor_; }

    /// Lets others lock the file for reading, as HDF5's readers do. Other writers are still kept
    /// out.
    void admit_readers();
    /// Makes the file a copy of another. If that fails, the file is removed: half of a copy is of
    /// no use.
    void copy_from(const std::filesystem::path& other);
    /// Syncs the content, renames the file to PATH while it is still locked, syncs the folder, and
    /// closes.
    void publish();
    /// Removes the file and closes it.
    void remove() noexcept;

    /// Returns the message of a failure: path, what could not be done, the system's reason.
    std::string message(const char* what, int error) const;

  private:
    bool open_and_lock();
    [[noreturn]] void fail(const char* what, int error);

    std::filesystem::path path_, partial_;
    int descriptor_ = -1;
};

}  // namespace tesserae
