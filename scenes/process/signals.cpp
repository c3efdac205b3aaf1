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

void on_signal(int number) {
    if (!graceful || requested.exchange(true)) _exit(128 + number);
    received = number;
}

}  // namespace

void handle_signals() {
    struct sigaction action = {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    // A file size limit then is an error of the write call, with a path and a reason.
    std::signal(SIGXFSZ, SIG_IGN);
}

void stop_gracefully_on_signals() { graceful = true; }

const std::atomic<bool>& stop_requested() { return requested; }

int stop_signal() { return received; }

}  // namespace tesserae::scenes
