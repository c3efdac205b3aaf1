// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

namespace tesserae::parallel {

/// Cores that this process may use: the least of its affinity mask, the cpu quotas of its control
/// groups (versions 1 and 2), rounded up, and Slurm's SLURM_CPUS_PER_TASK. At least 1.
int granted_cores();

/// More threads than this are taken for a mistake: each needs memory, and too many end the process.
constexpr int kMostThreads = 1024;

/// A number of threads for parallel work, which may be more than the cores. Several such objects
/// that live at once do not limit each other.
class Threads {
  public:
    /// @param count  the calling thread included
    /// @throws InputError   count < 1 or > kMostThreads
    explicit Threads(int count);
    ~Threads();
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    int count() const { return count_; }

    /// Calls work() in such a way that the parallel loops in it use these threads.
    void run(const std::function<void()>& work);

  private:
    struct Arena;
    int count_;
    std::unique_ptr<Arena> arena_;
};

}  // namespace tesserae::parallel
