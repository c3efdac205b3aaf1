// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/diagnostics/energy.hpp"

#include "core/dynamics/bodies/type_properties.hpp"

namespace tesserae {

double kinetic_energy(const Bodies& bodies) {
    const std::vector<TypeProperties> types = type_properties(bodies);
    double sum = 0;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const TypeProperties& type = types[bodies.type[id]];
        const BodyType& given = bodies.type_of(id);
        if (!type.bounded) continue;
        if (!given.fixed_position) sum += 0.5 * type.mass * bodies.velocity[id].squaredNorm();
        const Bivector& omega = bodies.angular_velocity[id];
        if (!given.fixed_rotation)
            sum += 0.5 * dot(omega, angular_momentum(type, bodies.rotor[id], omega));
    }
    return sum;
}

double potential_energy(const Bodies& bodies, const Vec4& gravity) {
    double sum = 0;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const BodyType& type = bodies.type_of(id);
        if (is_bounded(type.shape) && !type.fixed_position)
            sum -= type.mass * type.gravity_scale * gravity.dot(bodies.position[id]);
    }
    return sum;
}

}  // namespace tesserae
