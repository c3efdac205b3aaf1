#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// How all bodies move together [m/s]: not at all where contacts do not move some of them.
Vec4 drift_of(const Simulation& simulation, const StepData& step);

/// Up to what separation [m] a pair's points are found: see find_contacts().
struct Margins {
    /// Those that can close within one sub-step at the present relative velocity, and those that
    /// are within the allowed overlap of touching.
    double as_they_move;
    /// Those, too, that can close where others stop one of the bodies, at the other one's own speed
    /// beyond step.drift: bodies that fall one above the other would sink into each other as the
    /// lower one lands.
    double if_one_stops;
};
Margins margins_of(const Simulation& simulation, const StepData& step, BodyId a, BodyId b);

/// Narrow phase of a pair where its bodies are: appends its contacts to a list.
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
void find_warm_starts(const Simulation& simulation, StepData& step, Range contacts);

}  // namespace tesserae
