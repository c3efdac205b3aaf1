#pragma once

#include "core/dynamics/state/step_data.hpp"

namespace tesserae {

/// A body is still while no point of it moves faster than this part of its least half-size a second
/// (ten times the overlap that the solver leaves alone). More, and slow motion freezes; less, and
/// the last trembling of a pile keeps it awake.
constexpr double kStill = 10 * kSlop;

/// How long [s] all bodies of an island have to be still before it falls asleep: longer than a body
/// thrown upward is at its highest point.
constexpr double kTimeToSleep = 0.5;

/// Whether a contact of the range reaches a body that sleeps.
bool touches_sleeper(const StepData& step, Range contacts);

/// The sleeping islands that a contact reaches are awake from now on. Their bodies' contacts among
/// themselves have then not been looked for: look again.
/// @return whether any woke
bool wake_touched(const Simulation& simulation, StepData& step);

/// After the last sub-step: counts for how long bodies have been still, and lets the islands fall
/// asleep all of whose bodies have been so long enough and which touch nothing driven. The
/// velocities of bodies that fall asleep become zero in the step's result.
void fall_asleep(Simulation& simulation, StepData& step);

}  // namespace tesserae
