// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/bodies/bodies.hpp"

namespace tesserae {

void interpolate_poses(const Bodies& before, const Bodies& after, double part, Bodies& between) {
    for (BodyId id = 0; id < before.size(); ++id) {
        between.position[id] =
            before.position[id] + part * (after.position[id] - before.position[id]);
        const Rotor &a = before.rotor[id], &b = after.rotor[id];
        between.rotor[id] = a == b ? a : interpolate(a, b, part);
    }
}

std::optional<Turning> turning(const Bodies& before, const Bodies& after, double time, BodyId id) {
    const Rotor &a = before.rotor[id], &b = after.rotor[id];
    if (a == b) return {};
    const Bivector half_angle =
        0.25 * time * (before.angular_velocity[id] + after.angular_velocity[id]);
    return Turning{a, half_angle, log_of_rotation(b * reverse(exp(-half_angle) * a))};
}

}  // namespace tesserae
