#include "core/dynamics/state/bodies.hpp"

namespace tesserae {

void interpolate_poses(const Bodies& before, const Bodies& after, double part, Bodies& between) {
    for (BodyId id = 0; id < before.size(); ++id) {
        between.position[id] =
            before.position[id] + part * (after.position[id] - before.position[id]);
        const Rotor &a = before.rotor[id], &b = after.rotor[id];
        between.rotor[id] = a == b ? a : interpolate(a, b, part);
    }
}

namespace {

/// See follow_poses().
Rotor turned(const Rotor& a, const Rotor& b, const Bivector& angle, double part) {
    if (a == b) return a;
    const Rotor rest = b * reverse(exp(-0.5 * angle) * a);
    return interpolate(Rotor{}, rest, part) * exp(-0.5 * part * angle) * a;
}

}  // namespace

void follow_poses(const Bodies& before, const Bodies& after, double time, double part,
                  Bodies& between) {
    for (BodyId id = 0; id < before.size(); ++id) {
        between.position[id] =
            before.position[id] + part * (after.position[id] - before.position[id]);
        const Bivector angle =
            0.5 * time * (before.angular_velocity[id] + after.angular_velocity[id]);
        between.rotor[id] = turned(before.rotor[id], after.rotor[id], angle, part);
    }
}

}  // namespace tesserae
