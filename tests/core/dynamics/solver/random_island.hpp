// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <random>

#include "core/dynamics/islands/islands.hpp"
#include "core/dynamics/motion/motion.hpp"
#include "core/dynamics/step/step.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae::testing {

using Generator = std::mt19937_64;

inline Bivector random_bivector(Generator& random) {
    // One draw after the other: the order of a call's arguments is the compiler's.
    const Vec4 a = random_vector(random, 1), b = random_vector(random, 1);
    const Vec4 c = random_vector(random, 1), d = random_vector(random, 1);
    return wedge(a, b) + wedge(c, d);
}

inline PhysicsSettings settings_of(int iterations) {
    PhysicsSettings settings;
    settings.iterations = iterations;
    settings.tolerance = 0;
    return settings;
}

/// A sub-step before its islands are solved.
struct Unsolved {
    Simulation simulation;
    StepData step;
};

/// Bodies of all shapes that move at random and touch at random, one to eight points a pair, body 1
/// all others: so many pairs that some are left over. Boxes are `thinnest` along y. Two bodies do
/// not move, two only turn.
inline Unsolved random_island(double friction, bool spheres_only, double rolling = 0,
                              double thinnest = 0.5) {
    Generator random(3);
    Bodies bodies;
    constexpr BodyId kCount = 200;
    for (BodyId id = 0; id < kCount; ++id) {
        BodyType type = sphere_type(0.5, 1.0 + id % 5);
        if (!spheres_only && id % 4 == 1)
            type = box_type({1, thinnest, 1.4 * thinnest, 1.8 * thinnest}, 2);
        if (!spheres_only && id % 4 == 2) type = capsule_type(0.3, 1, 3);
        if (id % 50 == 7) type.fixed_position = type.fixed_rotation = true;
        if (id % 50 == 8) type.fixed_position = true;
        type.friction = friction * (0.5 + 0.01 * id);
        type.rolling_friction = id % 7 == 0 ? rolling : 0;
        type.restitution = id % 3 == 0 ? 0.5 : 0;
        const Vec4 place = random_vector(random, 3), velocity = random_vector(random, 1);
        const Bivector omega = random_bivector(random), turn = random_bivector(random);
        add(bodies, type, place, velocity, omega, exp(turn));
    }
    Unsolved world{make_simulation(bodies, settings_of(5)), {}};
    begin_step(world.simulation, world.step, kStep);
    advance_first_half(world.simulation, world.step, {0, kCount});
    for (BodyId a = 0; a < kCount; ++a)
        for (BodyId b = a + 1; b < kCount; ++b) {
            if (a != 1 && random() % 40 > 0) continue;
            if (!bodies.is_movable(a) && !bodies.is_movable(b)) continue;
            Contact contact;
            contact.a = a, contact.b = b;
            contact.normal = random_vector(random, 1).normalized();
            const std::uint64_t points = spheres_only ? 1 : 1 + random() % 8;
            for (std::uint32_t i = 0; i < points; ++i) {
                contact.feature = i;
                contact.separation = 1e-3 * random_vector(random, 1)[0] - 1e-3;
                contact.point = world.step.position[a] + random_vector(random, 0.7);
                world.step.contacts.push_back(contact);
                world.step.impulses.push_back(contact_impulse(
                    std::max(0.0, random_vector(random, 0.01)[0]), random_vector(random, 0.01)));
                world.step.hit.push_back(0);
            }
        }
    if (world.simulation.needs.rolling)
        for (const ContactImpulse& impulse : world.step.impulses)
            world.step.angular_impulses.push_back(impulse.normal * random_bivector(random));
    IslandBuilder(1).build(world.simulation, world.step);
    world.step.awaits.assign(world.step.islands.size(), Awaits::kImpact);
    return world;
}

}  // namespace tesserae::testing
