// SPDX-License-Identifier: Apache-2.0
#include "parallel/threads.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

#include "core/error.hpp"

namespace tesserae::parallel {
namespace {

TEST(GrantedCores, AreAtLeastOneAndNoMoreThanTheMachineHas) {
    EXPECT_GE(granted_cores(), 1);
    EXPECT_LE(granted_cores(), static_cast<int>(std::thread::hardware_concurrency()));
}

/// Returns how many threads work at once on as many tasks, each of which waits until all have
/// begun: only that many threads can get through without a long wait.
std::size_t working_at_once(Threads& threads) {
    const int count = threads.count();
    std::mutex mutex;
    std::condition_variable all_here;
    std::set<std::thread::id> ids;
    bool late = false;
    threads.run([&] {
        tbb::parallel_for(
            0, count, 1,
            [&](int) {
                std::unique_lock lock(mutex);
                ids.insert(std::this_thread::get_id());
                all_here.notify_all();
                const auto met = [&] { return static_cast<int>(ids.size()) == count || late; };
                if (!all_here.wait_for(lock, std::chrono::seconds(20), met)) late = true;
            },
            tbb::simple_partitioner());
    });
    return ids.size();
}

TEST(Threads, AllWorkAtOnceAlsoWhereTheyAreMoreThanTheCores) {
    for (int count : {1, 2, 3, 8, 16}) {
        Threads threads(count);
        EXPECT_EQ(threads.count(), count);
        EXPECT_EQ(working_at_once(threads), static_cast<std::size_t>(count));
    }
}

TEST(Threads, DoNotLimitOthersThatLiveAtOnce) {
    testing::internal::CaptureStderr();
    Threads one(1), two(2), many(12), some(7);
    for (Threads* threads : {&one, &two, &many, &some})
        EXPECT_EQ(working_at_once(*threads), static_cast<std::size_t>(threads->count()));
    // oneTBB warns there where it is asked for more threads than are allowed.
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Threads, LetExceptionsThrough) {
    Threads threads(2);
    EXPECT_THROW(threads.run([] { throw RunError("disk full"); }), RunError);
}

TEST(Threads, AreAtLeastOne) { EXPECT_THROW(Threads(0), InputError); }

}  // namespace
}  // namespace tesserae::parallel
