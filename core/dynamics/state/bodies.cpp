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

}  // namespace tesserae
