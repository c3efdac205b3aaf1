// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"

// What all fuzz targets share: files that lie in memory, and what a reader may say.
namespace tesserae::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// A file without a place on any disk, which readers open by its path.
class MemoryFile {
  public:
    explicit MemoryFile(std::string_view bytes) : descriptor_(::memfd_create("fuzz", MFD_CLOEXEC)) {
        if (descriptor_ < 0) std::perror("memfd_create"), std::abort();
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
            if (written <= 0) std::perror("write"), std::abort();
            bytes.remove_prefix(static_cast<std::size_t>(written));
        }
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  private:
    int descriptor_;
};

/// Ends the run as a crash: a reader has broken a promise.
[[noreturn]] inline void fail(const std::string& what) {
    std::fprintf(stderr, "broken promise: %s\n", what.c_str());
    std::abort();
}
inline void require(bool good, const char* what) {
    if (!good) fail(what);
}

/// Runs what reads. A reader may refuse what it is given, in words, by an InputError; any other
/// exception ends the run as a crash.
/// @return whether it was accepted
template <class Work>
bool accepts(Work&& work) {
    try {
        work();
        return true;
    } catch (const InputError& error) {
        require(*error.what() != '\0', "an error without words");
        return false;
    }
}

}  // namespace tesserae::fuzz
