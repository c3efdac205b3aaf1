// SPDX-License-Identifier: Apache-2.0
#include "scenes/process/scratch_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "core/error.hpp"

namespace tesserae::scenes {
namespace {

namespace fs = std::filesystem;

/// Opens a folder of this user's and locks it. @return its descriptor; -1: it is no such folder, or
/// its process lives
int lock_folder(const fs::path& path) {
    const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) return -1;
    struct stat about;
    if (::fstat(folder, &about) == 0 && about.st_uid == ::geteuid() &&
        ::flock(folder, LOCK_EX | LOCK_NB) == 0)
        return folder;
    ::close(folder);
    return -1;
}

/// A folder that was made this moment may not be locked yet: only older ones are left over.
bool is_old(int folder) {
    constexpr std::time_t kSeconds = 60;
    struct stat about;
    return ::fstat(folder, &about) == 0 && about.st_mtime < std::time(nullptr) - kSeconds;
}

/// What std::filesystem::temp_directory_path() has looked at.
std::string asked_place() {
    for (const char* name : {"TMPDIR", "TMP", "TEMP", "TEMPDIR"})
        if (const char* const place = std::getenv(name)) return place;
    return "/tmp";
}

void remove_leftovers(const fs::path& place, const std::string& prefix) {
    std::error_code error;
    for (fs::directory_iterator at(place, error), end; !error && at != end; at.increment(error)) {
        if (!at->path().filename().string().starts_with(prefix)) continue;
        const int folder = lock_folder(at->path());
        if (folder < 0) continue;
        std::error_code ignored;
        if (is_old(folder)) fs::remove_all(at->path(), ignored);
        ::close(folder);
    }
}

}  // namespace

ScratchFolder::ScratchFolder(const std::string& prefix) {
    std::error_code error;
    const fs::path place = fs::temp_directory_path(error);
    if (error)
        throw RunError(fmt::format("{}: no folder for temporary files: {}; set TMPDIR to one",
                                   asked_place(), error.message()));
    remove_leftovers(place, prefix);
    std::string name = (place / (prefix + "XXXXXX")).string();
    if (::mkdtemp(name.data()) == nullptr)
        throw RunError(fmt::format("{}: cannot be made: {}", name, std::strerror(errno)));
    path_ = name;
    lock_ = lock_folder(path_);
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    if (lock_ >= 0) ::close(lock_);
}

}  // namespace tesserae::scenes
