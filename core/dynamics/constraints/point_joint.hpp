#pragma once

#include "core/algebra/vector.hpp"
#include "core/dynamics/constraints/constraint.hpp"

namespace tesserae {

/// A joint that holds a point of one body at a point of the other. Both turn freely about it.
struct PointJoint {
    Vec4 on_a = Vec4::Zero(), on_b = Vec4::Zero();  ///< from the centres, in the bodies' axes [m]
};

/// Sets the rows and anchors of a point joint of a constraint's bodies, at their present poses.
RowErrors pose(const PointJoint& joint, const StepData& step, Constraint& constraint);

}  // namespace tesserae
