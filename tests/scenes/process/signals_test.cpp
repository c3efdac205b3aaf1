// SPDX-License-Identifier: Apache-2.0
#include "scenes/process/signals.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <ctime>

namespace tesserae::scenes {
namespace {

/// Begins a process that is asked to stop and goes on for so long [s].
pid_t begin_work(int signal, int seconds) {
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(STDERR_FILENO);
        handle_signals();
        stop_gracefully_on_signals();
        ::raise(signal);
        if (!stop_requested() || stop_signal() != signal) ::_exit(1);
        // A signal ends a sleep early.
        const std::time_t end = std::time(nullptr) + seconds;
        while (std::time(nullptr) < end) ::usleep(1000);
        ::_exit(0);
    }
    return child;
}

int status_at_end(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

TEST(Signals, EndWorkThatDoesNotStop) {
    const pid_t stops = begin_work(SIGTERM, 0);
    const pid_t terminated = begin_work(SIGTERM, 60), interrupted = begin_work(SIGINT, 60);
    EXPECT_EQ(status_at_end(stops), 0) << "it stopped";
    EXPECT_EQ(status_at_end(terminated), 143);
    EXPECT_EQ(status_at_end(interrupted), 130);
}

}  // namespace
}  // namespace tesserae::scenes
