// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bench/experiments/elliptic.hpp"
#include "bench/experiments/experiments.hpp"

// Bodies on joints whose motion has a closed form.
namespace tesserae::bench {
namespace {

constexpr double kLength = 1;  ///< of the pendulum, to the ball's centre [m]
constexpr double kSwing = 2;   ///< from straight down, at first [rad]

BodyType ball_type() { return sphere_type(kRadius, 1); }

/// Returns how far a ball is from a place, over a length.
double off(const Vec4& position, const Vec4& exact, double length) {
    return (position - exact).norm() / length;
}

}  // namespace

/// A ball on a rigid arm, let go at an angle a in a plane that lies askew to all axes. With
/// I = m l^2 + m R^2 / 3 about the point and w^2 = m g l / I the angle is 2 asin(k sn(K - w t)),
/// k = sin(a / 2): Landau and Lifshitz, Mechanics, section 11, problem 1.
Experiment pendulum(const Knobs& knobs) {
    const auto settings = settings_of(4, knobs, kDown);
    const Vec4 aside = Vec4(2, 0, -1, 2) / 3;
    const auto at = [=](double angle) -> Vec4 {
        return kLength * (std::sin(angle) * aside - std::cos(angle) * Vec4::UnitY());
    };
    Experiment experiment;
    experiment.name = "pendulum";
    experiment.settings = settings;
    add(experiment.bodies, ball_type(), at(kSwing));
    Joint joint;
    joint.b = 0;
    joint.kind = PointJoint{.on_b = Vec4(-at(kSwing))};
    experiment.joints = {joint};
    experiment.errors = [=](Trial& trial) -> std::vector<Error> {
        const double rate =
            std::sqrt(kGravity * kLength / (kLength * kLength + kRadius * kRadius / 3));
        const double k = std::sin(0.5 * kSwing), complement = std::cos(0.5 * kSwing);
        const double quarter = quarter_period(complement);
        double worst = 0, start = 0, change = 0;
        const auto energy_now = [&] { return energy(trial.bodies(), settings.gravity); };
        start = energy_now();
        trial.run([&](double time, const StepReport&) {
            const double angle = 2 * std::asin(k * elliptic(quarter - rate * time, complement).sn);
            worst = std::max(worst, off(trial.bodies().position[0], at(angle), kLength));
            change = std::max(change, std::abs(energy_now() - start));
        });
        const double swing = kGravity * kLength * (1 - std::cos(kSwing));
        return {{"position", "of the length", worst}, {"energy", "of the swing's", change / swing}};
    };
    return experiment;
}

/// A ball on a spring of no length, that pulls alike in all directions: x cos w t + v / w sin w t,
/// an ellipse of four dimensions.
Experiment oscillator(const Knobs& knobs) {
    const auto settings = settings_of(4, knobs, Vec4::Zero());
    const double rate = 2 * pi * 1.5;
    const Vec4 x(0.5, -0.2, 0.3, 0.4), v(1, 2, -1.5, 0.5);
    Experiment experiment;
    experiment.name = "oscillator";
    experiment.settings = settings;
    add(experiment.bodies, ball_type(), x, v);
    Joint joint;
    joint.b = 0;
    joint.kind = PointJoint{};
    joint.held = 0;
    for (int i = 0; i < 4; ++i) {
        JointDrive drive;
        drive.coordinate = i, drive.stiffness = rate * rate;
        joint.drives.push_back(drive);
    }
    experiment.joints = {joint};
    experiment.errors = [=](Trial& trial) -> std::vector<Error> {
        double worst = 0;
        trial.run([&](double time, const StepReport&) {
            const Vec4 exact = std::cos(rate * time) * x + std::sin(rate * time) / rate * v;
            worst = std::max(worst, off(trial.bodies().position[0], exact, x.norm()));
        });
        return {{"position", "of the first distance", worst}};
    };
    return experiment;
}

/// Twenty balls hung in a row at rest, the last one a hundred times as heavy: they stay, and each
/// joint bears what is below it.
Experiment hanging_chain(const Knobs& knobs) {
    constexpr int kLinks = 20;
    constexpr double kApart = 0.25, kLoad = 100;
    const auto settings = settings_of(2, knobs, kDown);
    Experiment experiment;
    experiment.name = "hanging_chain";
    experiment.settings = settings;
    for (int i = 0; i < kLinks; ++i) {
        const double mass = i + 1 == kLinks ? kLoad : 1;
        add(experiment.bodies, sphere_type(0.1, mass), {0, -kApart * (i + 0.5), 0, 0});
        Joint joint;
        joint.a = i == 0 ? kWorld : static_cast<BodyId>(i - 1);
        joint.b = static_cast<BodyId>(i);
        const Vec4 up(0, 0.5 * kApart, 0, 0);
        joint.kind = PointJoint{i == 0 ? Vec4(Vec4::Zero()) : Vec4(-up), up};
        experiment.joints.push_back(joint);
    }
    const std::vector<Vec4> start = experiment.bodies.position;
    experiment.errors = [=](Trial& trial) -> std::vector<Error> {
        double moved = 0;
        trial.run([&](double, const StepReport&) {
            for (std::size_t i = 0; i < start.size(); ++i)
                moved = std::max(moved, off(trial.bodies().position[i], start[i], kApart * kLinks));
        });
        double load = 0;
        for (int i = 0; i < kLinks; ++i) {
            const double exact = kGravity * (kLoad + kLinks - 1 - i) / settings.steps_per_second;
            const double has = trial.joint_impulses()[static_cast<std::size_t>(i)].impulse.norm();
            load = std::max(load, std::abs(has / exact - 1));
        }
        return {{"sag", "of the length", moved}, {"load", "relative", load}};
    };
    return experiment;
}

}  // namespace tesserae::bench
