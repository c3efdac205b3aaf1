#pragma once

#include "scenes/load/joint_keys.hpp"

namespace tesserae::scenes {

/// Sets the anchors and the length of a distance, rope or spring where the table has none, and
/// checks them against how the bodies are placed. It does nothing for other types.
/// @param b   kWorld: the table names none
/// @throws InputError   the anchors are too near to each other or too far apart
void set_length(TableReader& reader, JointTable& table, const Bodies& bodies, BodyId a, BodyId b);

/// Returns the joint that a checked table poses on bodies as they are placed. It measures the
/// motion of b relative to a, or that of a where b is kWorld.
/// @throws InputError   a spring or motor has a frequency where nothing can move
Joint make_joint(TableReader& reader, const JointTable& table, const Bodies& bodies, BodyId a,
                 BodyId b);

}  // namespace tesserae::scenes
