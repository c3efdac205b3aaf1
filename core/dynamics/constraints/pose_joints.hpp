// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/dynamics/constraints/constraint.hpp"

namespace tesserae {

/// Lists the joints of bodies that are awake in step.constraints, without what pose_joints() sets.
void list_joints(const Simulation& simulation, StepData& step);
/// Poses the constraints in the range, with their last impulses, for the middle of the sub-step.
///
/// What is held aims at no error in the middle of the next sub-step, if bodies go straight on and
/// turn freely until then. Together with the sub-step this is SHAKE (Ryckaert, Ciccotti, Berendsen,
/// J. Comput. Phys. 23, 1977), of second order, which neither gains nor loses energy on the whole.
/// A JointBlock aims again by how the bodies move after its load, see missed_by(); sweeps do not.
/// Joints that make a loop aim without what turning adds to the way, and are of first order. A
/// spring's force is that at the mean of the sub-step's ends (implicit midpoint rule), which keeps
/// its energy at any stiffness.
void pose_joints(const Simulation& simulation, StepData& step, std::size_t begin, std::size_t end);

/// Returns by how much a posed constraint that holds misses in the middle of the next sub-step,
/// beyond what its aim leaves of an error, if the bodies go on as they move now.
RowVector missed_by(const Simulation& simulation, const StepData& step, const Constraint& held);
/// Sets the rows and the anchor of a posed constraint that holds to those in the middle of the next
/// sub-step, if the bodies go on as they move now.
void pose_ahead(const Simulation& simulation, const StepData& step, Constraint& held);

}  // namespace tesserae
