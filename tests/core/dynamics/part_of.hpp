// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "core/dynamics/bodies/bodies.hpp"

namespace tesserae::testing {

/// Returns some bodies of a world, from one on.
inline Bodies part_of(const Bodies& bodies, std::size_t first, std::size_t count) {
    Bodies part = bodies;
    const auto cut = [&](auto& list) {
        list = {list.begin() + static_cast<std::ptrdiff_t>(first),
                list.begin() + static_cast<std::ptrdiff_t>(first + count)};
    };
    cut(part.type), cut(part.position), cut(part.rotor);
    cut(part.velocity), cut(part.angular_velocity);
    return part;
}

}  // namespace tesserae::testing
