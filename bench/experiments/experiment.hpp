// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "bench/bodies.hpp"
#include "bench/thread_time.hpp"
#include "core/dynamics/stepper.hpp"
#include "parallel/parallel_stepper.hpp"

namespace tesserae::bench {

constexpr double kGravity = 10;  ///< [m/s^2]
constexpr double kRadius = 0.5;  ///< of the spheres [m]; I = m R^2 / 3
inline const Vec4 kDown{0, -kGravity, 0, 0};

/// What is varied to trade error for run time.
struct Knobs {
    RotationIntegrator integrator = PhysicsSettings{}.integrator;
    int substeps = PhysicsSettings{}.substeps;       ///< a step
    int iterations = PhysicsSettings{}.iterations;   ///< a sub-step
    double tolerance = PhysicsSettings{}.tolerance;  ///< [m/s]
    int steps_per_second = 240;

    friend bool operator==(const Knobs&, const Knobs&) = default;
};

/// The one place where the knobs become settings.
PhysicsSettings settings_of(double duration, const Knobs& knobs, const Vec4& gravity);

/// The world of one run: core's own or, for crowds, the one that sorts and sweeps, which gives the
/// same bits. A crowd belongs inside Threads::run().
class Trial {
  public:
    Trial(const Bodies& bodies, const PhysicsSettings& settings, bool crowd = false,
          const std::vector<Joint>& joints = {});

    const Bodies& bodies() const;
    const StepMemory& memory() const;
    /// As Stepper::joint_impulses().
    std::span<const Wrench> joint_impulses() const;

    /// Makes all steps of the duration.
    void run();
    /// The same, with a call of after(time, report) behind each step.
    void run(const std::function<void(double, const StepReport&)>& after);

    /// As Stepper::observe().
    void observe(StageObserver* observer);

    /// Processor time of all steps [s].
    double seconds() const { return seconds_; }

  private:
    StepReport step();

    PhysicsSettings settings_;
    std::variant<Stepper, parallel::ParallelStepper> world_;
    double seconds_ = 0;
};

/// A difference from an exact result.
struct Error {
    std::string quantity, unit;
    double value;  ///< >= 0
};

/// A motion whose result is known.
struct Experiment {
    std::string name;  ///< letters, digits and underscores: results are files of this name
    Bodies bodies;
    PhysicsSettings settings;  ///< from settings_of()
    /// Runs a new trial of these bodies and settings, and compares.
    std::function<std::vector<Error>(Trial&)> errors;
    bool crowd = false;
    std::vector<Joint> joints = {};
};

/// The half-space under y = 0.
Bodies floor_of(double friction, double restitution);

BodyType box_type(const Vec4& size, double mass, double friction);

/// The angle [rad] of the rotation between two orientations, both planes' together.
double angle_between(const Rotor& a, const Rotor& b);

/// Kinetic and potential [J].
double energy(const Bodies& bodies, const Vec4& gravity);

}  // namespace tesserae::bench
