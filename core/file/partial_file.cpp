// SPDX-License-Identifier: Apache-2.0
#include "core/file/partial_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>
#include <vector>

#include "core/error.hpp"

namespace tesserae {
namespace {

/// Bytes that are copied at once, usual 1 MiB: far fewer make more calls than the copying takes.
constexpr std::size_t kCopiedAtOnce = 1 << 20;

template <class Call>
auto retried(Call&& call) {
    decltype(call()) result;
    do result = call();
    while (result < 0 && errno == EINTR);
    return result;
}

/// A name is safe from a power cut once its folder is synced. @return errno, 0 if done
int sync_folder(const std::filesystem::path& parent) {
    const char* name = parent.empty() ? "." : parent.c_str();
    const int folder = retried([&] { return ::open(name, O_RDONLY | O_DIRECTORY | O_CLOEXEC); });
    if (folder < 0) return errno;
    const int error = retried([&] { return ::fsync(folder); }) == 0 ? 0 : errno;
    ::close(folder);
    // Some network file systems cannot sync folders, which is no failure of ours.
    return error == EINVAL ? 0 : error;
}

/// Gives an open file the content of another. @return errno, 0 if done
int copy_content(int from, int to) {
    if (retried([&] { return ::ftruncate(to, 0); }) != 0) return errno;
    std::vector<char> buffer(kCopiedAtOnce);
    for (off_t done = 0;;) {
        const ssize_t there =
            retried([&] { return ::pread(from, buffer.data(), buffer.size(), done); });
        if (there < 0) return errno;
        if (there == 0) return 0;
        // A write may end early: then the rest is read again.
        const ssize_t written = retried(
            [&] { return ::pwrite(to, buffer.data(), static_cast<std::size_t>(there), done); });
        if (written < 0) return errno;
        if (written == 0) return EIO;
        done += written;
    }
}

}  // namespace

PartialFile::PartialFile(std::filesystem::path path)
    : path_(std::move(path)), partial_(path_.string() + ".partial") {
    // A folder in the place of the file would be noticed only by the rename, after all the work.
    struct stat there;
    if (::stat(path_.c_str(), &there) == 0 && S_ISDIR(there.st_mode))
        fail("cannot be written", EISDIR);
    while (!open_and_lock()) {
    }
}

/// False if the file was renamed or removed by its last owner between opening and locking.
bool PartialFile::open_and_lock() {
    // Not truncated before the lock is ours: the content may be another process's.
    constexpr int kFlags = O_CREAT | O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK;
    descriptor_ = retried([&] { return ::open(partial_.c_str(), kFlags, 0666); });
    if (descriptor_ < 0) fail("cannot be created", errno);
    if (retried([&] { return ::flock(descriptor_, LOCK_EX | LOCK_NB); }) != 0)
        fail("cannot be locked", errno);

    struct stat held, named;
    if (::fstat(descriptor_, &held) != 0) fail("cannot be examined", errno);
    if (!S_ISREG(held.st_mode)) fail("cannot be written", EEXIST);
    if (::lstat(partial_.c_str(), &named) == 0 && held.st_ino == named.st_ino &&
        held.st_dev == named.st_dev)
        return true;
    ::close(descriptor_);
    descriptor_ = -1;
    return false;
}

PartialFile::~PartialFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void PartialFile::admit_readers() {
    // The change is not atomic: if another writer locks it in between, this one gives way.
    if (retried([&] { return ::flock(descriptor_, LOCK_SH | LOCK_NB); }) != 0)
        fail("cannot be locked", errno);
}

void PartialFile::copy_from(const std::filesystem::path& other) {
    const int source = retried([&] { return ::open(other.c_str(), O_RDONLY | O_CLOEXEC); });
    const int error = source < 0 ? errno : copy_content(source, descriptor_);
    if (source >= 0) ::close(source);
    if (error == 0) return;
    remove();
    throw RunError(fmt::format("{}: cannot be copied to {}: {}", other.string(), partial_.string(),
                               std::generic_category().message(error)));
}

void PartialFile::publish() {
    // A failure up to here leaves the file under its unfinished name, still locked.
    if (retried([&] { return ::fsync(descriptor_); }) != 0)
        throw RunError(message("cannot be synced", errno));
    if (std::rename(partial_.c_str(), path_.c_str()) != 0)
        throw RunError(message("cannot be renamed", errno));
    const int descriptor = std::exchange(descriptor_, -1);
    const int error = sync_folder(path_.parent_path());
    // After EINTR the descriptor is closed all the same, and its content was synced.
    const bool closed = ::close(descriptor) == 0 || errno == EINTR;
    const int close_error = errno;
    if (error != 0) throw RunError(message("its folder cannot be synced", error));
    if (!closed) throw RunError(message("cannot be closed", close_error));
}

void PartialFile::remove() noexcept {
    if (descriptor_ < 0) return;
    // Unlinked while locked: it cannot be another process's by now.
    ::unlink(partial_.c_str());
    ::close(descriptor_);
    descriptor_ = -1;
}

std::string PartialFile::message(const char* what, int error) const {
    if (error == EWOULDBLOCK)
        return fmt::format("{}: is being written by another process", path_.string());
    return fmt::format("{}: {}: {}", path_.string(), what, std::generic_category().message(error));
}

void PartialFile::fail(const char* what, int error) {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
    if (error == EWOULDBLOCK) throw BusyError(message(what, error));
    throw RunError(message(what, error));
}

}  // namespace tesserae
