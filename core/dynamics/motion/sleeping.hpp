// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/constants.hpp"
#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Returns whether a contact of the range touches a body that sleeps.
bool touches_sleeper(const StepData& step, Range contacts);

/// Wakes the sleeping islands that a contact touches. Contacts among their bodies have not been
/// looked for: search again if any woke.
/// @return whether any woke
bool wake_touched(const Simulation& simulation, StepData& step);

/// Lets islands fall asleep after the last sub-step: all their bodies have been still and not got
/// faster for long enough, something that does not move carries them (or all their bodies stand),
/// and they touch nothing driven. It also counts the time for which bodies have been still. The
/// velocities of bodies that fall asleep become zero in the step's result.
void fall_asleep(Simulation& simulation, StepData& step);

}  // namespace tesserae
