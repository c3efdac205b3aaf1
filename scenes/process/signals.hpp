// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

// SIGINT and SIGTERM: the one piece of state that a process has only once.
namespace tesserae::scenes {

/// From here on SIGINT and SIGTERM end the process at once with status 130 or 143: nothing has been
/// written yet, so nothing can be lost, however long loading takes.
void handle_signals();

/// From here on the first signal asks the work to stop where its files are whole; a second one, or
/// a second without having stopped, ends the process at once: unfinished files keep their .partial
/// names, with what was last flushed.
void stop_gracefully_on_signals();

/// Set by a signal during graceful work.
const std::atomic<bool>& stop_requested();

/// The signal that asked to stop, 0 if none did.
int stop_signal();

}  // namespace tesserae::scenes
