// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/dynamics/step/step_data.hpp"
#include "core/world/world.hpp"

namespace tesserae {

/// Makes a World of a simulation: its bodies and joints have the numbers of their places in it.
World make_world(Simulation simulation, std::shared_ptr<Workers> workers = {});

}  // namespace tesserae
