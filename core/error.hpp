#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace tesserae {

/// What a user gave (command line, file, argument) is wrong: the program prints it and exits
/// with 2. The message names the place, the value, what was expected and, where one exists, the
/// remedy.
struct InputError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Something failed while running (disk full, a body left the finite range): exit status 1.
struct RunError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The user asked to stop (SIGINT, SIGTERM): unwinds to the program, which keeps what is finished.
struct Stopped : std::exception {
    const char* what() const noexcept override { return "stopped"; }
};

[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

}  // namespace tesserae

/// An invariant of our own, checked in every build.
#define TSR_ASSERT(condition) \
    ((condition) ? void(0) : ::tesserae::assertion_failed(#condition, __FILE__, __LINE__))
