// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "core/file/partial_file.hpp"

namespace tesserae {

/// A FileWriter writes a file; it is the only way in which files are written. Bytes go to
/// PATH.partial. finish() checks, syncs and closes it, renames it to PATH and syncs the folder, so
/// that a file under its final name is always complete. Without finish() the destructor removes
/// what was written. The partial file is locked (flock): a second process that writes the same file
/// gets an error, and a leftover of a killed one is overwritten. Any failure (disk full, folder
/// missing or read-only, locked) throws RunError with the path and the system's reason. It is
/// remembered: every later call throws it again.
class FileWriter {
  public:
    explicit FileWriter(std::filesystem::path path);
    ~FileWriter();
    FileWriter(const FileWriter&) = delete;
    FileWriter& operator=(const FileWriter&) = delete;

    void write(const void* data, std::size_t bytes);
    void seek(std::uint64_t position);
    std::uint64_t position() const { return position_; }
    void finish();

  private:
    void require_good() const;
    void flush();
    void write_at(std::uint64_t position, const char* data, std::size_t bytes);
    [[noreturn]] void fail(const char* what, int error);

    PartialFile file_;
    std::string buffer_;  ///< the bytes just before position_, not yet in the file
    std::uint64_t position_ = 0;
    std::string failure_;  ///< message of the first failure
};

/// Writes a whole file at once, for example a report.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Writes files that several processes may write at once, all of them the same content: calls
/// `write` until it meets no file that another process holds.
/// @param patience   usual 10 s: a small file on a slow network file system takes less
/// @throws BusyError   another process holds a file for longer than that; Stopped once `stop` is
/// set
void write_when_free(const std::function<void()>& write, const std::atomic<bool>& stop,
                     std::chrono::milliseconds patience = std::chrono::seconds(10));

}  // namespace tesserae
