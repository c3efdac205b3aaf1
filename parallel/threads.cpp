#include "parallel/threads.hpp"

#include <sched.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>

#include "core/error.hpp"

namespace tesserae::parallel {
namespace {

int cores_of_affinity() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    return std::max(1, CPU_COUNT(&set));
}

/// Quota over period [cores] of one control group; none if it has no limit or no such file.
std::optional<double> quota_of_version_2(const std::string& folder) {
    std::ifstream file(folder + "/cpu.max");
    double quota = 0, period = 0;
    if (file >> quota >> period && quota > 0 && period > 0) return quota / period;
    return std::nullopt;  // "max 100000" is no number: no limit
}

std::optional<double> quota_of_version_1(const std::string& folder) {
    std::ifstream quota_file(folder + "/cpu.cfs_quota_us");
    std::ifstream period_file(folder + "/cpu.cfs_period_us");
    double quota = 0, period = 0;
    if (quota_file >> quota && period_file >> period && quota > 0 && period > 0)
        return quota / period;
    return std::nullopt;
}

/// The least quota of a group and of all groups that hold it.
double least_quota(const std::string& root, std::string group,
                   std::optional<double> (*quota_of)(const std::string&)) {
    double least = std::numeric_limits<double>::infinity();
    for (;;) {
        if (const auto quota = quota_of(root + group)) least = std::min(least, *quota);
        const std::size_t slash = group.rfind('/');
        if (slash == std::string::npos) return least;
        group.erase(slash);
    }
}

double cores_of_control_groups() {
    double least = std::numeric_limits<double>::infinity();
    std::ifstream file("/proc/self/cgroup");
    // Lines are hierarchy:controllers:group; version 2 has no controllers.
    for (std::string line; std::getline(file, line);) {
        std::istringstream fields(line);
        std::string hierarchy, controllers, group;
        std::getline(fields, hierarchy, ':');
        std::getline(fields, controllers, ':');
        std::getline(fields, group);
        if (controllers.empty())
            least = std::min(least, least_quota("/sys/fs/cgroup", group, quota_of_version_2));
        else if (("," + controllers + ",").find(",cpu,") != std::string::npos)
            least = std::min(least, least_quota("/sys/fs/cgroup/cpu", group, quota_of_version_1));
    }
    return least;
}

}  // namespace

int granted_cores() {
    const int cores = cores_of_affinity();
    const double quota = std::ceil(cores_of_control_groups());
    return quota < cores ? std::max(1, static_cast<int>(quota)) : cores;
}

/// oneTBB starts no more threads than cores unless it is told that more are allowed.
struct Threads::Arena {
    explicit Arena(int count)
        : allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count)),
          arena(count) {}

    tbb::global_control allowed;
    tbb::task_arena arena;
};

Threads::Threads(int count) : count_(count) {
    if (count < 1) throw InputError(fmt::format("threads = {}: must be at least 1", count));
    arena_ = std::make_unique<Arena>(count);
}

Threads::~Threads() = default;

void Threads::run(const std::function<void()>& work) { arena_->arena.execute(work); }

}  // namespace tesserae::parallel
