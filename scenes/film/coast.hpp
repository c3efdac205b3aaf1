// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/algebra/rotor.hpp"
#include "core/dynamics/bodies/bodies.hpp"

namespace tesserae::scenes {

/// Moves bodies for a time [s] (back, if it is negative) at the velocities that they have.
inline void coast(Bodies& bodies, double time) {
    for (BodyId id = 0; id < bodies.size(); ++id) {
        bodies.position[id] += time * bodies.velocity[id];
        if (!(bodies.angular_velocity[id] == Bivector{}))
            bodies.rotor[id] = exp(-0.5 * time * bodies.angular_velocity[id]) * bodies.rotor[id];
    }
}

}  // namespace tesserae::scenes
