// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "bench/bodies.hpp"

// Motions of a 3D box that two engines make, and what they are compared by.
namespace tesserae::bench {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kBoxMass = 2;       ///< [kg]
constexpr double kBoxGravity = 10;   ///< along -y [m/s^2]
constexpr double kBoxDuration = 2;   ///< [s]
constexpr int kBoxSamples = 40;      ///< of the path, at equal times
constexpr int kBoxIterations = 200;  ///< of the contact solver: converged

/// A box, and the half-space under it whose surface holds the origin. No restitution.
struct BoxMotion {
    std::string name;
    Vector3d sides = {0.5, 0.2, 0.3};  ///< full [m]
    double friction = 0;               ///< coefficient of box against floor
    double slope = 0;                  ///< of the floor, turned about z [rad]
    bool has_floor = true;
    Vector3d position;                             ///< centre [m]
    Matrix3d rotation;                             ///< body to world
    Vector3d velocity = Vector3d::Zero();          ///< [m/s]
    Vector3d angular_velocity = Vector3d::Zero();  ///< the 3D vector, world [rad/s]
    std::optional<double> travel;  ///< exact distance from start to end, where known [m]
};

struct BoxPlace {
    Vector3d position;
    Matrix3d rotation;
    double w = 0;         ///< |w| of the centre [m]; 0 in 3D
    double w_turned = 0;  ///< sine of the angle from the body's w axis to the world's; 0 in 3D
};

/// Its places at the times k kBoxDuration/kBoxSamples, k = 1 ... kBoxSamples.
using BoxPath = std::vector<BoxPlace>;

/// Steps from one sample to the next.
inline int steps_of_sample(int steps_per_second) {
    return static_cast<int>(kBoxDuration * steps_per_second) / kBoxSamples;
}

inline Matrix3d turned_about(const Vector3d& axis, double angle) {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// A box whose lowest point is 1 m above the floor.
inline BoxMotion thrown_box(const std::string& name, double friction, const Matrix3d& rotation,
                            const Vector3d& velocity, const Vector3d& angular_velocity) {
    BoxMotion m;
    m.name = name;
    m.friction = friction;
    m.position = {0, 1 + 0.5 * rotation.row(1).cwiseAbs() * m.sides, 0};
    m.rotation = rotation;
    m.velocity = velocity;
    m.angular_velocity = angular_velocity;
    return m;
}

/// A box that lies on the floor, turned about its normal by `yaw`, and slides along x at first. By
/// Coulomb's law friction is opposite to the slip: the path is straight and no box turns, whatever
/// its yaw.
inline BoxMotion lying_box(const std::string& name, double friction, double slope, double yaw,
                           double speed) {
    const Matrix3d floor = turned_about(Vector3d::UnitZ(), slope);
    BoxMotion m;
    m.name = name;
    m.friction = friction;
    m.slope = slope;
    m.position = floor * Vector3d(0, 0.5 * m.sides.y(), 0);
    m.rotation = floor * turned_about(Vector3d::UnitY(), yaw);
    m.velocity = floor * Vector3d(speed, 0, 0);
    const double a = kBoxGravity * (std::sin(-slope) - friction * std::cos(slope));
    m.travel = a < 0 ? speed * speed / (-2 * a)
                     : kBoxDuration * speed + 0.5 * a * kBoxDuration * kBoxDuration;
    return m;
}

/// In none of them do two seconds suffice for step-size errors to grow out of hand. With friction a
/// thrown box stays in the plane xy: in space its slip turns during an impact, and there the
/// engines differ in what they solve, since Bullet keeps the direction of the slip before it.
inline std::vector<BoxMotion> box_motions() {
    const Vector3d z = Vector3d::UnitZ();
    const Matrix3d tilted = turned_about({1, 2, 3}, 0.5);
    BoxMotion free = thrown_box("tumbling in the air", 0, tilted, {1, 2, 0.5}, {0.1, 3, 0.2});
    free.has_floor = false;
    return {free,
            thrown_box("drop in space without friction", 0, tilted, {1, 0, 0.5}, {3, 1, -2}),
            thrown_box("drop in a plane with friction 0.2", 0.2, turned_about(z, 0.9), {2, 0, 0},
                       -2 * z),
            thrown_box("drop in a plane with friction 0.5", 0.5, turned_about(z, 0.9), {2, 0, 0},
                       -2 * z),
            lying_box("slide along a side with friction 0.5", 0.5, 0, 0, 3),
            lying_box("slide askew with friction 0.5", 0.5, 0, 0.6, 3),
            lying_box("incline of 30 degrees with friction 0.3", 0.3, -pi / 6, 0, 0),
            lying_box("incline of 30 degrees askew with friction 0.3", 0.3, -pi / 6, 0.6, 0)};
}

}  // namespace tesserae::bench
