// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/schedule.hpp"

namespace tesserae {

/// Copies what a stage of the real step finds when it begins. Measurements and tests then run the
/// next stages on copies of it.
class StageCopy : public StageObserver {
  public:
    explicit StageCopy(Stage stage) : stage_(stage) {}

    void begin(Stage stage, std::size_t, const Simulation& now, const StepData& found) override {
        if (stage != stage_) return;
        simulation = now;
        step = found;
    }
    void end(Stage) override {}

    Simulation simulation;  ///< as the stage last found it
    StepData step;

  private:
    Stage stage_;
};

}  // namespace tesserae
