// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace tesserae {

/// An InputError says that something that a user gave (command line, file, argument) is wrong. The
/// program prints it and exits with 2. The message names the place, the value, what was expected
/// and, where one exists, the remedy.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A RunError says that something failed while running (disk full, a body left the finite range).
/// The program exits with 1.
struct RunError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Stopped is thrown when the user asks to stop (SIGINT, SIGTERM). It unwinds to the program, which
/// keeps what is finished.
struct Stopped : std::exception {
    const char* what() const noexcept override { return "stopped"; }
};

/// Throws std::logic_error that names the place and the broken invariant.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

}  // namespace tesserae

/// Checks an invariant of our own, in every build.
#define TSR_ASSERT(condition) \
    ((condition) ? void(0) : ::tesserae::assertion_failed(#condition, __FILE__, __LINE__))
