// SPDX-License-Identifier: Apache-2.0
#include "core/file/file_writer.hpp"

#include <unistd.h>

#include <cerrno>
#include <thread>

#include "core/error.hpp"

namespace tesserae {
namespace {

/// Small writes (EXR headers, PNG rows) gather up to this many bytes, usual 64 KiB: far more and
/// they leave the cache, far less and every one is a system call.
constexpr std::size_t kBufferBytes = 64 * 1024;

/// Between two looks at a file that another process writes.
constexpr std::chrono::milliseconds kPause{5};

}  // namespace

FileWriter::FileWriter(std::filesystem::path path) : file_(std::move(path)) {
    buffer_.reserve(kBufferBytes);
    // What a killed process left is of no use here.
    int result;
    do result = ::ftruncate(file_.descriptor(), 0);
    while (result != 0 && errno == EINTR);
    if (result != 0) {
        const int error = errno;
        file_.remove();
        fail("cannot be emptied", error);
    }
}

FileWriter::~FileWriter() { file_.remove(); }

void FileWriter::write(const void* data, std::size_t bytes) {
    require_good();
    if (buffer_.size() + bytes > kBufferBytes) flush();
    const char* begin = static_cast<const char*>(data);
    if (bytes > kBufferBytes)
        write_at(position_, begin, bytes);
    else
        buffer_.append(begin, bytes);
    position_ += bytes;
}

void FileWriter::seek(std::uint64_t position) {
    require_good();
    flush();
    position_ = position;
}

void FileWriter::finish() {
    require_good();
    flush();
    try {
        file_.publish();
    } catch (const RunError& error) {
        failure_ = error.what();
        throw;
    }
}

void FileWriter::require_good() const {
    if (!failure_.empty()) throw RunError(failure_);
}

void FileWriter::flush() {
    write_at(position_ - buffer_.size(), buffer_.data(), buffer_.size());
    buffer_.clear();
}

void FileWriter::write_at(std::uint64_t position, const char* data, std::size_t bytes) {
    // A signal may interrupt a write before or amid its bytes.
    while (bytes > 0) {
        const ssize_t written =
            ::pwrite(file_.descriptor(), data, bytes, static_cast<off_t>(position));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail("cannot be written", errno);
        if (written == 0) fail("cannot be written", EIO);
        data += written;
        bytes -= static_cast<std::size_t>(written);
        position += static_cast<std::uint64_t>(written);
    }
}

void FileWriter::fail(const char* what, int error) {
    failure_ = file_.message(what, error);
    throw RunError(failure_);
}

void write_file(const std::filesystem::path& path, std::string_view content) {
    FileWriter writer(path);
    writer.write(content.data(), content.size());
    writer.finish();
}

void write_when_free(const std::function<void()>& write, const std::atomic<bool>& stop,
                     std::chrono::milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    for (;;) {
        try {
            return write();
        } catch (const BusyError&) {
            if (std::chrono::steady_clock::now() >= end) throw;
        }
        if (stop) throw Stopped();
        std::this_thread::sleep_for(kPause);
    }
}

}  // namespace tesserae
