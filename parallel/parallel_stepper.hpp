// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "core/dynamics/stepper.hpp"

namespace tesserae::parallel {

class ThreadedSchedule;
class Trace;

/// core's Stepper on several threads: the same step, on a ThreadedSchedule, with the same bits at
/// any number of threads.
class ParallelStepper {
  public:
    /// @throws InputError   as make_simulation()
    ParallelStepper(Bodies bodies, const PhysicsSettings& settings);
    explicit ParallelStepper(Simulation simulation);
    ~ParallelStepper();

    /// Advances by dt [s], on the threads of the arena in which the first call is made: every call
    /// belongs inside run() of the same Threads.
    /// @param stop               see Stepper
    /// @throws InputError        dt is not finite or not > 0
    /// @throws LeftFiniteRange   bodies() and memory() are then as before the call
    StepReport step(double dt, const StopQuestion* stop = nullptr);

    /// Drops what is kept to make the next step faster. It changes no result.
    void forget_hints();

    /// From the next step on the observer sees every stage; null ends that. Changes no result.
    void observe(StageObserver* observer) { world_.observe(observer); }
    /// The same for a trace: every stage is a span under its name, and so is every message of
    /// islands. Takes the observer's place.
    void set_trace(Trace* trace);

    const Bodies& bodies() const { return world_.bodies(); }
    const StepMemory& memory() const { return world_.memory(); }
    StepMemory& memory() { return world_.memory(); }
    const Joints& joints() const { return world_.simulation().joints; }
    /// See Stepper.
    std::span<const Wrench> joint_impulses() const { return world_.joint_impulses(); }

  private:
    class StageSpans;

    Stepper world_;
    std::unique_ptr<ThreadedSchedule> schedule_;  ///< from the first step on
    Trace* trace_ = nullptr;
    std::unique_ptr<StageSpans> spans_;  ///< of the trace
};

}  // namespace tesserae::parallel
