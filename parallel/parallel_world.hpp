#pragma once

#include <memory>

#include "core/dynamics/step.hpp"

namespace tesserae::parallel {

class Trace;

/// core's World on several threads: the same stages, the same functions of core, the same bits at
/// any number of threads.
class ParallelWorld {
  public:
    /// @throws InputError   as make_simulation()
    ParallelWorld(Bodies bodies, const PhysicsSettings& settings);
    ~ParallelWorld();

    /// Advances by dt [s], on the threads of the arena in which the first call is made: every call
    /// belongs inside run() of the same Threads.
    /// @throws InputError        dt is not finite or not > 0
    /// @throws LeftFiniteRange   bodies() and memory() are then as before the call
    StepReport step(double dt);

    /// Drops what is kept to make the next step faster. It changes no result.
    void forget_hints();

    /// From the next step on every stage is a span of the trace, under its name, and so is every
    /// message of islands. Null ends that. Changes no result.
    void set_trace(Trace* trace) { trace_ = trace; }

    const Bodies& bodies() const { return simulation_.bodies; }
    const StepMemory& memory() const { return simulation_.memory; }
    StepMemory& memory() { return simulation_.memory; }

  private:
    struct Stages;

    void advance_first_half();
    void find_pairs();
    void find_contacts();
    void integrate_velocities();
    void build_islands();
    void solve_islands();
    void advance_second_half();
    void relax_islands();
    StepReport finish_step();
    void require_finite() const;

    Simulation simulation_;
    StepData step_;
    std::unique_ptr<Stages> stages_;  ///< from the first step on
    Trace* trace_ = nullptr;
};

}  // namespace tesserae::parallel
