#include "scenes/memory.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

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

/// The least that any group from `group` up to the mount point `root` leaves. Page cache that the
/// group could drop counts as used; that errs on the safe side.
std::uint64_t groups_available(const std::filesystem::path& root, std::filesystem::path group,
                               const char* limit, const char* usage) {
    std::uint64_t least = kUnlimited;
    for (group = group.relative_path();; group = group.parent_path()) {
        const auto folder = root / group;
        least = std::min(least, left_of(number_in(folder / limit), number_in(folder / usage)));
        if (group.empty()) return least;
    }
}

std::uint64_t cgroup_available() {
    std::uint64_t least = kUnlimited;
    std::ifstream in("/proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::filesystem::path group = line.substr(second + 1);
        if (controllers.empty())
            least = std::min(
                least, groups_available("/sys/fs/cgroup", group, "memory.max", "memory.current"));
        else if (controllers.find("memory") != std::string::npos)
            least =
                std::min(least, groups_available("/sys/fs/cgroup/memory", group,
                                                 "memory.limit_in_bytes", "memory.usage_in_bytes"));
    }
    return least;
}

std::uint64_t address_space_left() {
    rlimit limit = {};
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
    std::ifstream in("/proc/self/statm");
    std::uint64_t pages = 0;
    in >> pages;
    return left_of(limit.rlim_cur, pages * 4096);
}

}  // namespace

std::uint64_t available_memory() {
    return std::min({machine_available(), cgroup_available(), address_space_left()});
}

}  // namespace tesserae::scenes
