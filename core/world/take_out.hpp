// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/step/step_data.hpp"

namespace tesserae {

/// Takes bodies and joints out of a simulation: out of its lists and its memory, whose order stays.
/// Types that no body has any more go too. What is computed from the bodies fits no more.
/// @param removed   of every body, 1 if it goes; so of every joint, or none. The joints of bodies
///                  that go are among them.
void take_out(Simulation& simulation, const std::vector<std::uint8_t>& removed,
              const std::vector<std::uint8_t>& removed_joints);

}  // namespace tesserae
