// SPDX-License-Identifier: Apache-2.0
#include "scenes/process/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "parallel/control_groups.hpp"

namespace tesserae::scenes {
namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

std::uint64_t number_in(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::uint64_t value = 0;
    return in >> value ? value : kUnlimited;  // "max" is no number: unlimited
}

std::uint64_t left_of(std::uint64_t limit, std::uint64_t used) {
    if (limit == kUnlimited || used == kUnlimited) return kUnlimited;
    return limit > used ? limit - used : 0;
}

std::uint64_t machine_available() {
    std::ifstream in("/proc/meminfo");
    for (std::string word; in >> word;)
        if (std::uint64_t kib = 0; word == "MemAvailable:" && in >> kib) return kib * 1024;
    return kUnlimited;
}

/// The least that any control group leaves. Page cache that a group could drop counts as used; that
/// errs on the safe side.
std::uint64_t groups_available() {
    std::uint64_t least = kUnlimited;
    for (const auto& [folder, version] : parallel::control_groups("memory")) {
        const bool is_second = version == 2;
        const std::uint64_t limit =
            number_in(folder / (is_second ? "memory.max" : "memory.limit_in_bytes"));
        const std::uint64_t used =
            number_in(folder / (is_second ? "memory.current" : "memory.usage_in_bytes"));
        least = std::min(least, left_of(limit, used));
    }
    return least;
}

std::uint64_t address_space_left() {
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
    std::ifstream in("/proc/self/statm");
    std::uint64_t pages = 0;
    in >> pages;
    return left_of(limit.rlim_cur, pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)));
}

/// Of what Slurm has granted to this job on its node, which not every site enforces:
/// SLURM_MEM_PER_NODE [MiB]; 0 is all.
std::uint64_t slurm_available() {
    const char* text = std::getenv("SLURM_MEM_PER_NODE");
    const std::uint64_t mib = text != nullptr ? std::strtoull(text, nullptr, 10) : 0;
    if (mib == 0) return kUnlimited;
    std::ifstream in("/proc/self/statm");
    std::uint64_t size = 0, resident = 0;
    in >> size >> resident;
    return left_of(mib << 20, resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)));
}

}  // namespace

std::uint64_t available_memory() {
    return std::min(
        {machine_available(), groups_available(), address_space_left(), slurm_available()});
}

void return_large_memory() {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 128 * 1024);  // as it is at first: once set it does not grow
#endif
}

}  // namespace tesserae::scenes
