// SPDX-License-Identifier: Apache-2.0
#include "parallel/threads.hpp"

#include <sched.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <optional>

#include "core/error.hpp"
#include "parallel/control_groups.hpp"

namespace tesserae::parallel {
namespace {

int cores_of_affinity() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    return std::max(1, CPU_COUNT(&set));
}

/// Quota over period [cores] of one control group; infinite if it has no limit or no such file.
double quota_of(const ControlGroup& group) {
    double quota = 0, period = 0;
    if (group.version == 2) {
        // "max 100000" is no number: no limit.
        std::ifstream(group.folder / "cpu.max") >> quota >> period;
    } else {
        std::ifstream(group.folder / "cpu.cfs_quota_us") >> quota;
        std::ifstream(group.folder / "cpu.cfs_period_us") >> period;
    }
    const bool is_limited = quota > 0 && period > 0;
    return is_limited ? quota / period : std::numeric_limits<double>::infinity();
}

double cores_of_control_groups() {
    double least = std::numeric_limits<double>::infinity();
    for (const ControlGroup& group : control_groups("cpu"))
        least = std::min(least, quota_of(group));
    return least;
}

/// What Slurm has granted to this task: not every site binds tasks to their cores.
int cores_of_slurm() {
    const char* text = std::getenv("SLURM_CPUS_PER_TASK");
    const int cores = text != nullptr ? std::atoi(text) : 0;
    return cores > 0 ? cores : std::numeric_limits<int>::max();
}

}  // namespace

int granted_cores() {
    const int cores = std::min(cores_of_affinity(), cores_of_slurm());
    const double quota = std::ceil(cores_of_control_groups());
    return quota < cores ? std::max(1, static_cast<int>(quota)) : cores;
}

/// oneTBB starts no more threads than cores unless it is told that more are allowed. What it is
/// told holds for the whole process, and the least number of several counts: so the number is the
/// same for all, and only the arena says how many threads work in it.
struct Threads::Arena {
    explicit Arena(int count) : arena(count) {
        if (count > tbb::info::default_concurrency())
            allowed.emplace(tbb::global_control::max_allowed_parallelism, kMostThreads);
    }

    std::optional<tbb::global_control> allowed;
    tbb::task_arena arena;
};

Threads::Threads(int count) : count_(count) {
    if (count < 1 || count > kMostThreads)
        throw InputError(fmt::format("threads = {}: expected 1 to {}", count, kMostThreads));
    arena_ = std::make_unique<Arena>(count);
}

Threads::~Threads() = default;

void Threads::run(const std::function<void()>& work) { arena_->arena.execute(work); }

}  // namespace tesserae::parallel
