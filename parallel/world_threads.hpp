// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "core/world/workers.hpp"

namespace tesserae {

/// Makes threads on which worlds are stepped: `World world({}, threads(8))`. Several worlds may
/// share them, also while they are stepped at the same time. Several such objects that live at once
/// do not limit each other.
/// @param count   the calling thread included; 0: as many as the cores that this process may use
/// @throws InputError   count < 0 or > 1024
std::shared_ptr<Workers> threads(int count = 0);

}  // namespace tesserae
