// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// The separations [m] up to which a pair's points are found: see find_contacts().
struct Margins {
    /// For points that can close within one sub-step at the present relative velocity, or are
    /// within the slop of touching. Points of a body that turns are found less far ahead: where it
    /// will be then they do not say, and FastBodies stops it where it touches.
    double as_they_move;
    /// Also for points that can close if others stop one of the bodies, at the other one's speed:
    /// bodies that fall one above the other would sink into each other as the lower one lands.
    double if_one_stops;
};
/// Returns the slop for bodies that cannot touch within the sub-step: what is found must not depend
/// on which other pairs step.pairs has from an earlier sub-step.
Margins margins_of(const Simulation& simulation, const StepData& step, BodyId a, BodyId b);

/// Does the narrow phase of a pair at the bodies' present poses and appends its contacts to a list.
/// @return as find_contacts() of two shapes
double find_contacts_of(const Simulation& simulation, const StepData& step, const BodyPair& pair,
                        double margin, std::vector<Contact>& list);
/// Does the narrow phase of step.pairs in the range.
void find_contacts(const Simulation& simulation, const StepData& step, Range pairs,
                   std::vector<Contact>& list);

/// Sizes the sub-step's arrays of contacts, once these are known.
void begin_contacts(const Simulation& simulation, StepData& step);

/// Sets step.impulses (and angular ones) of the contacts in the range to what the last sub-step
/// left for the same (a, b, feature), else to zero.
void find_warm_starts(const Simulation& simulation, StepData& step, Range contacts);

}  // namespace tesserae
