// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/error.hpp"
#include "core/function_ref.hpp"

namespace tesserae {

/// The question whether work is to end before it is done. Long work asks it after every piece of
/// some microseconds to milliseconds, and several threads may ask it at once.
using StopQuestion = FunctionRef<bool()>;

/// Asks, if there is a question.
/// @throws Stopped   the work is to end
inline void look_for_stop(const StopQuestion* stop) {
    if (stop != nullptr && (*stop)()) throw Stopped();
}

}  // namespace tesserae
