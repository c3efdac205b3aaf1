// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/algebra/vector.hpp"

// Jointed balls that every engine can build: what ropes and nets are measured by.
namespace tesserae::bench {

constexpr double kJointedStep = 1.0 / 240;  ///< [s]
constexpr double kJointedGravity = 10;      ///< along -y [m/s^2]

/// Balls at rest in z = w = 0 or in w = 0, joined by points. Two of them that are joined do not
/// collide; there is no friction.
struct JointedScene {
    struct Link {
        std::size_t a, b;  ///< balls
        Vec4 anchor;       ///< in the world [m]
    };
    std::string name;
    double radius = 0.1;         ///< of all balls [m]
    std::vector<double> mass;    ///< of every ball; 0: it is held [kg]
    std::vector<Vec4> position;  ///< of every ball [m]
    std::vector<Link> links;
    int steps = 0;  ///< that are measured, from the start
};

/// A level net of side x side balls, 0.25 m apart, whose first row is held: it falls and swings.
JointedScene net(int side, int steps);

/// A level row of balls, 0.25 m apart, the first held, the last of so many times the others' mass.
JointedScene rope(int balls, double load, int steps);

/// A scene in one engine, on one thread, with nothing asleep.
class JointedEngine {
  public:
    virtual ~JointedEngine() = default;
    virtual void step() = 0;
    /// Returns how far the two anchors of a joint are apart, at most of all joints [m].
    virtual double largest_error() const = 0;
    /// Returns the kinetic and the potential energy [J].
    virtual double energy() const = 0;
    virtual double potential_energy() const = 0;
};

/// tesserae in four dimensions.
/// @param iterations   at most, until the default tolerance is reached
std::unique_ptr<JointedEngine> jointed_in_tesserae(const JointedScene& scene, int iterations);
/// Bullet in three, with btPoint2PointConstraint at its defaults.
std::unique_ptr<JointedEngine> jointed_in_bullet(const JointedScene& scene, int iterations);

}  // namespace tesserae::bench
