#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Whether what two bounded bodies can reach has a point in common.
inline bool overlap(const Bounds& a, const Bounds& b) {
    const double reach = a.radius + b.radius;
    return (a.centre - b.centre).squaredNorm() <= reach * reach;
}

/// Whether a bounded body can reach a body without bounds, by the distance of its centre.
bool reaches(const Bounds& bounded, const Shape& unbounded);

/// The rest of is_pair(), of two whose bounds overlap.
bool is_pair_of_overlapping(const Simulation& simulation, const StepData& step, BodyId a, BodyId b);

/// Whether the narrow phase has to look at bodies a < b: contacts can move at least one, at least
/// one is awake or driven, and where one can be within the step the other can be too. Every way of
/// finding pairs decides by this.
inline bool is_pair(const Simulation& simulation, const StepData& step, BodyId a, BodyId b) {
    return overlap(step.bounds[a], step.bounds[b]) &&  // the unbounded's are infinite
           is_pair_of_overlapping(simulation, step, a, b);
}

/// step.pairs by testing every two bodies: the reference for faster ways.
void test_all_pairs(const Simulation& simulation, StepData& step);

}  // namespace tesserae
