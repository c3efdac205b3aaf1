// SPDX-License-Identifier: Apache-2.0
#include "parallel/world_threads.hpp"

#include "parallel/threaded_schedule.hpp"
#include "parallel/threads.hpp"

namespace tesserae {
namespace {

/// Threads of oneTBB.
class ArenaWorkers : public Workers {
  public:
    explicit ArenaWorkers(int count) : threads_(count) {}

    int count() const override { return threads_.count(); }
    void run(FunctionRef<void()> work) override { threads_.run(work); }
    std::unique_ptr<Schedule> schedule() override {
        return std::make_unique<parallel::ThreadedSchedule>();
    }

  private:
    parallel::Threads threads_;
};

}  // namespace

std::shared_ptr<Workers> threads(int count) {
    return std::make_shared<ArenaWorkers>(count == 0 ? parallel::granted_cores() : count);
}

}  // namespace tesserae
