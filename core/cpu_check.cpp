// SPDX-License-Identifier: Apache-2.0
// Stops with a clear message on a CPU that lacks what the rest was compiled for. This file alone is
// compiled without -march, and its check runs before every other initialiser of the program.
#include "core/cpu_check.hpp"

#include <unistd.h>

#include <cstring>

namespace {

__attribute__((constructor(101))) void require_cpu() {
    if (cpu_suffices()) return;
    if (write(STDERR_FILENO, kCpuMessage, std::strlen(kCpuMessage)) < 0) _exit(1);
    if (write(STDERR_FILENO, "\n", 1) < 0) _exit(1);
    _exit(1);
}

}  // namespace
