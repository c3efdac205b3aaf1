// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "scenes/plan/plan.hpp"

namespace tesserae::scenes {

/// How many bodies have a type for which predicate(type) holds.
inline std::uint64_t count_if_type(const Bodies& bodies, auto&& predicate) {
    return std::count_if(bodies.type.begin(), bodies.type.end(),
                         [&](std::uint32_t type) { return predicate(type); });
}

/// Appends what the picture needs and what is left out of it.
void decide_picture(const Scene& scene, Plan& plan);
/// Appends how many bodies the camera's slice misses. Looks at every body: only for who asks.
void count_off_slice(const Scene& scene, Plan& plan);
/// Warns of bodies of glass that nobody sees, as they lie in glass that is declared later.
void warn_of_hidden_glass(const Scene& scene, Plan& plan);

}  // namespace tesserae::scenes
