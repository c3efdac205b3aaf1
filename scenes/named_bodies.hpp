// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "core/dynamics/bodies/bodies.hpp"

namespace tesserae::scenes {

/// A run of consecutive bodies under one name: a [[body]] or a [[lattice]].
struct NamedBodies {
    std::string name;
    BodyId first = 0;
    std::uint32_t count = 1;
    bool is_lattice = false;
};

}  // namespace tesserae::scenes
