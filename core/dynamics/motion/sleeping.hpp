#pragma once

#include "core/dynamics/constants.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Whether a contact of the range reaches a body that sleeps.
bool touches_sleeper(const StepData& step, Range contacts);

/// The sleeping islands that a contact reaches are awake from now on. Their bodies' contacts among
/// themselves have then not been looked for: look again.
/// @return whether any woke
bool wake_touched(const Simulation& simulation, StepData& step);

/// After the last sub-step: counts for how long bodies have been still and not got faster, and lets
/// the islands fall asleep all of whose bodies have been so long enough, which something that does
/// not move carries (or all of whose bodies stand) and which touch nothing driven. The velocities
/// of bodies that fall asleep become zero in the step's result.
void fall_asleep(Simulation& simulation, StepData& step);

}  // namespace tesserae
