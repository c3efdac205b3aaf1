#pragma once

#include "core/dynamics/state/step_data.hpp"

namespace tesserae {

/// Up to what separation [m] a pair's points are found: see find_contacts().
double margin_of(const Simulation& simulation, const StepData& step, BodyId a, BodyId b);

/// Narrow phase of a pair where its bodies are: appends its contacts to a list. With the margin of
/// margin_of() these are points that can close within one sub-step at the present relative
/// velocity, and those that are within the allowed overlap of touching.
/// @return as find_contacts() of two shapes
double find_contacts_of(const Simulation& simulation, const StepData& step, const BodyPair& pair,
                        double margin, std::vector<Contact>& list);
/// That of step.pairs in the range.
void find_contacts(const Simulation& simulation, const StepData& step, Range pairs,
                   std::vector<Contact>& list);

/// Sizes the sub-step's arrays of contacts, once these are known.
void begin_contacts(const Simulation& simulation, StepData& step);

/// step.impulses (and angular ones) of the contacts in the range: what the last sub-step left for
/// the same (a, b, feature), else zero.
void recall_impulses(const Simulation& simulation, StepData& step, Range contacts);

}  // namespace tesserae
