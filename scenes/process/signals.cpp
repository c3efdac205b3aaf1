// SPDX-License-Identifier: Apache-2.0
#include "scenes/process/signals.hpp"

#include <unistd.h>

#include <csignal>

namespace tesserae::scenes {
namespace {

std::atomic<bool> graceful{false};
std::atomic<bool> requested{false};
std::atomic<int> received{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler may touch lock-free atomics only");

/// How long work that was asked to stop may go on [s].
constexpr unsigned kMostSeconds = 1;

void on_signal(int number) {
    if (!graceful || requested.exchange(true)) _exit(128 + number);
    received = number;
    alarm(kMostSeconds);
}

/// The work has not stopped: a row or a picture of very many bodies takes longer to write. Files
/// bear an end at any moment.
void on_alarm(int) {
    constexpr char kSaid[] =
        "tesserae: ended amid work after a signal; what was stored before is kept, the same "
        "command continues\n";
    (void)!write(STDERR_FILENO, kSaid, sizeof kSaid - 1);
    _exit(128 + received);
}

}  // namespace

void handle_signals() {
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    action.sa_handler = on_alarm;
    sigaction(SIGALRM, &action, nullptr);
    // A file size limit then is an error of the write call, with a path and a reason.
    std::signal(SIGXFSZ, SIG_IGN);
}

void stop_gracefully_on_signals() { graceful = true; }

const std::atomic<bool>& stop_requested() { return requested; }

int stop_signal() { return received; }

}  // namespace tesserae::scenes
