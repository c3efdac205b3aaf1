// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Returns whether the balls that two bounded bodies can reach have a point in common.
inline bool overlap(const Bounds& a, const Bounds& b) {
    const double reach = a.radius + b.radius;
    return (a.centre - b.centre).squaredNorm() <= reach * reach;
}

/// Returns whether a bounded body can reach an unbounded one, by the distance of its centre.
bool reaches(const Bounds& bounded, const Shape& unbounded);

/// Returns whether two bodies whose bounds overlap are a pair, see is_pair().
bool is_pair_of_overlapping(const Simulation& simulation, const StepData& step, BodyId a, BodyId b);

/// Returns whether the narrow phase has to look at bodies a < b: their groups collide, contacts can
/// move at least one, at least one is awake or driven, and both can be at one place within the
/// step. Every way of finding pairs decides by this.
inline bool is_pair(const Simulation& simulation, const StepData& step, BodyId a, BodyId b) {
    return overlap(step.bounds[a], step.bounds[b]) &&  // the unbounded's are infinite
           is_pair_of_overlapping(simulation, step, a, b);
}

/// Finds step.pairs by testing every two bodies. It is the reference for faster ways.
void test_all_pairs(const Simulation& simulation, StepData& step);

}  // namespace tesserae
