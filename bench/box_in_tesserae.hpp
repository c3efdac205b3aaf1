// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bench/box_motions.hpp"
#include "core/dynamics/stepper.hpp"

namespace tesserae::bench {

/// Side along w of the box that lies in w = 0 [m]: changes nothing there.
constexpr double kBoxThickness = 0.4;

/// The box with the same sides along x, y, z and the same mass: its inertia in the planes xy, xz
/// and yz is that of the 3D box.
inline Bodies bodies_of(const BoxMotion& motion) {
    const auto in_space = [](const Vector3d& v) { return Vec4(v.x(), v.y(), v.z(), 0); };
    Bodies bodies;
    BodyType box;
    box.shape = Hyperbox{{motion.sides.x(), motion.sides.y(), motion.sides.z(), kBoxThickness}};
    box.mass = kBoxMass;
    box.friction = motion.friction;
    const Vector3d& omega = motion.angular_velocity;
    Bivector planes;
    planes.yz = omega.x(), planes.xz = -omega.y(), planes.xy = omega.z();
    add(bodies, box, in_space(motion.position), in_space(motion.velocity), planes);
    Mat4 rotation = Mat4::Identity();
    rotation.topLeftCorner<3, 3>() = motion.rotation;
    bodies.rotor[0] = to_rotor(rotation);

    const Vec4 normal(-std::sin(motion.slope), std::cos(motion.slope), 0, 0);
    if (motion.has_floor) add(bodies, plane_type(normal, 0, motion.friction, 0), Vec4::Zero());
    return bodies;
}

inline BoxPath path_in_tesserae(const BoxMotion& motion, int steps_per_second) {
    PhysicsSettings settings;
    settings.gravity = {0, -kBoxGravity, 0, 0};
    settings.iterations = kBoxIterations;
    settings.tolerance = 0;  // all of them, as Bullet does
    Stepper world(bodies_of(motion), settings);
    BoxPath path;
    for (int sample = 0; sample < kBoxSamples; ++sample) {
        for (int i = 0; i < steps_of_sample(steps_per_second); ++i)
            world.step(1.0 / steps_per_second);
        const Vec4& x = world.bodies().position[0];
        const Mat4 R = to_matrix(world.bodies().rotor[0]);
        path.push_back(
            {x.head<3>(), R.topLeftCorner<3, 3>(), std::abs(x[3]), R.col(3).head<3>().norm()});
    }
    return path;
}

}  // namespace tesserae::bench
