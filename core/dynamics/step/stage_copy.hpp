#pragma once

#include "core/dynamics/step/schedule.hpp"

namespace tesserae {

/// Keeps what a stage of the real step found when it began, to measure or test what comes next on
/// copies of it.
class StageCopy : public StageObserver {
  public:
    explicit StageCopy(Stage stage) : stage_(stage) {}

    void begin(Stage stage, std::size_t, const Simulation& now, const StepData& found) override {
        if (stage != stage_) return;
        simulation = now;
        step = found;
    }
    void end(Stage) override {}

    Simulation simulation;  ///< of the last time
    StepData step;

  private:
    Stage stage_;
};

}  // namespace tesserae
