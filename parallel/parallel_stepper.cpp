// SPDX-License-Identifier: Apache-2.0
#include "parallel/parallel_stepper.hpp"

#include <optional>
#include <utility>

#include "parallel/threaded_schedule.hpp"
#include "parallel/trace.hpp"

namespace tesserae::parallel {

/// Makes each stage a span of a trace.
class ParallelStepper::StageSpans : public StageObserver {
  public:
    explicit StageSpans(Trace* trace) : trace_(trace) {}

    void begin(Stage stage, std::size_t items, const Simulation&, const StepData&) override {
        span_.emplace(trace_, name_of(stage), items);
    }
    void end(Stage) override { span_.reset(); }

  private:
    Trace* trace_;
    std::optional<Trace::Span> span_;
};

ParallelStepper::ParallelStepper(Bodies bodies, const PhysicsSettings& settings)
    : world_(std::move(bodies), settings) {}

ParallelStepper::ParallelStepper(Simulation simulation) : world_(std::move(simulation)) {}

ParallelStepper::~ParallelStepper() = default;

StepReport ParallelStepper::step(double dt, const StopQuestion* stop) {
    // A graph works in the arena that it is built in, and the first step is the first to know it.
    if (!schedule_) schedule_ = std::make_unique<ThreadedSchedule>();
    schedule_->set_trace(trace_);
    return world_.step(dt, *schedule_, stop);
}

void ParallelStepper::forget_hints() {
    if (schedule_) schedule_->forget_hints();
}

void ParallelStepper::set_trace(Trace* trace) {
    trace_ = trace;
    spans_ = trace ? std::make_unique<StageSpans>(trace) : nullptr;
    world_.observe(spans_.get());
}

}  // namespace tesserae::parallel
