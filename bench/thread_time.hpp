// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <time.h>

namespace tesserae::bench {

/// Processor time of this thread [s]: other work on the machine disturbs it less than wall time.
inline double thread_time() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace tesserae::bench
