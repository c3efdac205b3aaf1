// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "core/dynamics/bodies/bodies.hpp"
#include "core/dynamics/step/memory.hpp"
#include "core/dynamics/step/settings.hpp"
#include "core/dynamics/stepper.hpp"
#include "tests/scenes/properties/small_scene.hpp"

namespace tesserae::scenes::properties {

/// From where and how bodies move.
struct Start {
    Bodies bodies;
    PhysicsSettings physics;
    double step = 0;  ///< time step [s]
};
Start start_of(const SmallScene& scene);

/// Changes bodies after a step; for defects that tests plant, and for rounding.
using Change = std::function<void(Bodies&, int step)>;

/// Bodies that move as core's serial step moves them, but for the change after every step.
class Motion {
  public:
    explicit Motion(const Start& start, Change change = {});
    /// @param observer   sees it, if there is one
    void step(StageObserver* observer = nullptr);
    const Bodies& bodies() const { return world_.bodies(); }
    const Stepper& world() const { return world_; }
    const StepReport& report() const { return report_; }  ///< of the last step
    double time_step() const { return step_; }            ///< [s]
    /// From what it has left goes on a new world.
    void start_anew();

  private:
    Stepper world_;
    double step_;
    int taken_ = 0;
    StepReport report_;
    Change change_;
};

// What leaves the laws of motion as they are: the same start seen otherwise.

/// Turned by a rotor about the origin, then moved.
Start moved(Start start, const Rotor& turn, const Vec4& shift);
/// The bodies of `moved` alone, at any time.
void move_bodies(Bodies& bodies, const Rotor& turn, const Vec4& shift);

/// With x and -x exchanged. Bodies of which there is no mirror image by their parameters become
/// hulls of points.
Start mirrored(Start start);
/// The poses and motions of `mirrored` alone, at any time.
void mirror_motion(Bodies& bodies);

/// With all lengths, times and masses so many times as large, by powers of two.
struct Scaling {
    int length = 0, time = 0, mass = 0;  ///< exponents
};
Start scaled(Start start, const Scaling& scaling);
/// The positions and motions of `scaled` alone, at any time.
void scale_motion(Bodies& bodies, const Scaling& scaling);

/// The sizes that differences are compared with.
struct Sizes {
    double length = 0;  ///< largest distance from the origin to a point of a body [m]
    double speed = 0;   ///< largest of a point of a body, and what gravity adds in a step [m/s]
};
Sizes sizes_of(const Start& start);

/// How far apart the same bodies are in two states, as a part of the sizes: the largest of
/// distances of corresponding points of their bounding balls, and differences of their velocities.
double difference(const Bodies& a, const Bodies& b, const Sizes& sizes);

}  // namespace tesserae::scenes::properties
