// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/dynamics/constraints/joint.hpp"
#include "core/dynamics/constraints/joint_rules.hpp"

namespace tesserae {

/// Sets the anchors and the length of a distance, rope or spring where the description has none,
/// and checks them against how the bodies are placed. It does nothing for other types.
/// @param fail   throws
/// @param b   kWorld: the joint is with the world; anchor_b is then there
void set_length(JointDescription& joint, const Bodies& bodies, BodyId a, BodyId b, FailJoint fail);

/// Returns the joint that a checked description poses on bodies as they are placed. It measures the
/// motion of b relative to a, or that of a where b is kWorld. It fails where a spring or motor has
/// a frequency and nothing can move.
Joint make_joint(const JointDescription& joint, const Bodies& bodies, BodyId a, BodyId b,
                 FailJoint fail);

}  // namespace tesserae
