// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <cstdint>
#include <functional>

#include "scenes/scene_file.hpp"

namespace tesserae::python {

/// How long work is told how far it is, and ends it.
struct Control {
    ProgressFunction progress;
    const std::atomic<bool>* stop;
};

/// Does work that takes long in a thread of its own, without Python's lock, which must be held.
/// Meanwhile this thread tells `progress` how far it is, and lets Python handle signals, so that
/// Ctrl-C ends the work. What either of them, or the work, throws is thrown once the work has
/// ended.
/// @param progress   callable of (done, total), True for a line on standard error, or None
/// @param work       is given what it has to heed
void run_watched(const pybind11::object& progress, const std::function<void(const Control&)>& work);

}  // namespace tesserae::python
