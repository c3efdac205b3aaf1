// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <vector>

#include "core/world/make_world.hpp"
#include "core/world/world.hpp"
#include "tests/core/dynamics/builder.hpp"

namespace tesserae::testing {

/// Adds all bodies to a world, in their order.
inline std::vector<BodyId> add_all(World& world, const Bodies& bodies) {
    std::vector<BodyId> ids;
    for (BodyId i = 0; i < bodies.size(); ++i)
        ids.push_back(world.add(
            bodies.type_of(i),
            {bodies.position[i], bodies.rotor[i], bodies.velocity[i], bodies.angular_velocity[i]}));
    return ids;
}

/// Whether two worlds hold the same in every bit.
inline bool same_worlds(const World& a, const World& b) { return a.save() == b.save(); }

inline PhysicsSettings sleepy_settings() {
    PhysicsSettings settings;
    settings.sleeping = true;
    return settings;
}

/// A heap of spheres, boxes and capsules, a stack that sleeps soon, a chain of three links on a
/// hinge, and things that roll: whatever a world has to remember.
inline World busy_world() {
    World world(sleepy_settings());
    world.add(plane_type(Vec4::UnitY(), 0, 0.5));
    const Bodies heap = mixed_heap(20, 2);
    for (BodyId i = 0; i < heap.size(); ++i)
        if (is_bounded(heap.type_of(i).shape))
            world.add(heap.type_of(i), {heap.position[i], heap.rotor[i], heap.velocity[i],
                                        heap.angular_velocity[i]});
    BodyType box = box_type(Vec4::Ones(), 10);
    box.friction = 0.5;
    for (int i = 0; i < 3; ++i) world.add(box, {{20, 0.5 + i, 0, 0}, {}, Vec4::Zero(), {}});
    BodyType ball = sphere_type(0.5, 2, 0.5);
    ball.rolling_friction = 0.01;
    world.add(ball, {{-20, 0.5, 0, 0}, {}, {1, 0, 0, 0.5}, {}});
    BodyId last = kWorld;
    for (int i = 0; i < 3; ++i) {
        const BodyId link =
            world.add(capsule_type(0.1, 0.5), {{40, 5 - 0.6 * i, 0, 0}, {}, {1, 0, 0, 1}, {}});
        JointDescription joint;
        joint.anchor = {40, 5.3 - 0.6 * i, 0, 0};
        world.join(joint, link, last);
        last = link;
    }
    return world;
}

}  // namespace tesserae::testing
