// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/function_ref.hpp"

namespace tesserae {

class Schedule;

/// The threads that worlds are stepped on. Several worlds may share them. `threads()` of
/// <tesserae/threads.hpp> makes them.
class Workers {
  public:
    virtual ~Workers() = default;

    /// Returns the number of threads.
    virtual int count() const = 0;
    /// Calls work(), whose parallel loops use these threads.
    virtual void run(FunctionRef<void()> work) = 0;
    /// Makes what shares out the steps of one world. It is called, and used, inside run().
    virtual std::unique_ptr<Schedule> schedule() = 0;
};

}  // namespace tesserae
