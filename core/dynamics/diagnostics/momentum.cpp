// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/diagnostics/momentum.hpp"

#include "core/dynamics/bodies/type_properties.hpp"

namespace tesserae {

Vec4 total_momentum(const Bodies& bodies) {
    Vec4 sum = Vec4::Zero();
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const BodyType& type = bodies.type_of(id);
        if (is_bounded(type.shape) && !type.fixed_position) sum += type.mass * bodies.velocity[id];
    }
    return sum;
}

Bivector total_angular_momentum(const Bodies& bodies) {
    const std::vector<TypeProperties> types = type_properties(bodies);
    Bivector sum;
    for (BodyId id = 0; id < bodies.size(); ++id) {
        const TypeProperties& type = types[bodies.type[id]];
        const BodyType& given = bodies.type_of(id);
        if (!type.bounded) continue;
        if (!given.fixed_position)
            sum += type.mass * wedge(bodies.position[id], bodies.velocity[id]);
        if (!given.fixed_rotation)
            sum += angular_momentum(type, bodies.rotor[id], bodies.angular_velocity[id]);
    }
    return sum;
}

}  // namespace tesserae
