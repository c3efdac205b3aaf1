// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "bench/experiments/elliptic.hpp"
#include "bench/experiments/experiments.hpp"
#include "bench/experiments/free_rotation.hpp"
#include "core/dynamics/diagnostics/energy.hpp"
#include "core/error.hpp"

// Boxes that turn freely: no gravity, nothing touches.
namespace tesserae::bench {
namespace {

const Vec4 kSize{1, 0.7, 0.4, 0.2};  ///< [m]

Bodies turning_box(const Bivector& omega, const Rotor& rotor = {}) {
    Bodies bodies;
    add(bodies, box_type(kSize, 1, 0), Vec4::Zero(), Vec4::Zero(), omega);
    bodies.rotor[0] = rotor;
    return bodies;
}

/// Largest difference of the kinetic energy from its start, of the start.
struct EnergyError {
    double start, worst = 0;

    explicit EnergyError(const Bodies& bodies) : start(kinetic_energy(bodies)) {}
    void see(const Bodies& now) {
        worst = std::max(worst, std::abs(kinetic_energy(now) / start - 1));
    }
    Error error() const { return {"energy", "relative", worst}; }
};

}  // namespace

/// Rotations in the body's planes xy and zw do not touch each other's axes: the angular momentum is
/// parallel to the angular velocity plane by plane, so both are constant in the world and in the
/// body, for any moments, and R(t) = exp(-t omega/2) R(0).
Experiment double_rotation(const Knobs& knobs) {
    const auto settings = settings_of(2, knobs, Vec4::Zero());
    const Rotor start = exp(Bivector{0.3, -0.2, 0.5, 0.1, 0.7, -0.4});
    const Bivector omega = rotate(start, Bivector{3, 0, 0, 0, 0, 2.1});
    return {"double_rotation", turning_box(omega, start), settings,
            [=](Trial& trial) -> std::vector<Error> {
                trial.run();
                const Rotor exact = exp(-0.5 * settings.duration * omega) * start;
                const Bodies& now = trial.bodies();
                return {{"angular velocity", "relative",
                         norm(now.angular_velocity[0] - omega) / norm(omega)},
                        {"orientation", "rad", angle_between(now.rotor[0], exact)}};
            }};
}

/// Angular velocity in all six planes, against Runge-Kutta on the rotation matrix.
Experiment free_box(const Knobs& knobs) {
    const Bivector omega{1.2, -0.7, 0.5, 2.1, -1.4, 0.9};
    const auto settings = settings_of(2, knobs, Vec4::Zero());
    static const Bivector exact =
        free_rotation(kSize.cwiseAbs2() / 12, omega, settings.duration, 20000);
    const Bodies bodies = turning_box(omega);
    return {"free_box", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
                EnergyError energy_error(bodies);
                trial.run([&](double, const StepReport&) { energy_error.see(trial.bodies()); });
                const Bivector now = trial.bodies().angular_velocity[0];
                return {{"angular velocity", "relative", norm(now - exact) / norm(omega)},
                        energy_error.error()};
            }};
}

namespace {

/// A rigid body in xyz, starting close to rotation about its middle axis, after Landau and
/// Lifshitz, Mechanics, section 37, with I1 < I2 < I3 and M^2 > 2 E I2:
///   Omega_1 = sqrt((2 E I3 - M^2)/(I1 (I3 - I1))) cn(tau), Omega_2 = sqrt((2 E I3 - M^2)/(I2 (I3 -
///   I2))) sn(tau), Omega_3 = sqrt((M^2 - 2 E I1)/(I3 (I3 - I1))) dn(tau),
///   tau = K + t sqrt((I3 - I2) (M^2 - 2 E I1)/(I1 I2 I3)),
///   k^2 = (I2 - I1) (2 E I3 - M^2)/((I3 - I2) (M^2 - 2 E I1)).
/// At t = 0, Omega_1 = 0 and Omega_3 is least. Omega_2 changes sign every 2 K.
struct Racket {
    double I1, I2, I3;
    double spin, push;  ///< Omega_2 and Omega_3 at the start [rad/s]

    double two_E = I2 * spin * spin + I3 * push * push;
    double M2 = I2 * I2 * spin * spin + I3 * I3 * push * push;
    double a = two_E * I3 - M2, b = M2 - two_E * I1;
    /// k'^2 = 1 - k^2 = (I3 - I1) (M^2 - 2 E I2)/((I3 - I2) (M^2 - 2 E I1)), in which M^2 - 2 E I2
    /// = I3 (I3 - I2) Omega_3^2 at the start.
    double complement = std::sqrt((I3 - I1) * I3 / b) * push;
    double rate = std::sqrt((I3 - I2) * b / (I1 * I2 * I3));
    double quarter = quarter_period(complement);

    double time_of_flip() const { return 2 * quarter / rate; }
    Eigen::Vector3d at(double time) const {
        const Elliptic e = elliptic(quarter + rate * time, complement);
        return {std::sqrt(a / (I1 * (I3 - I1))) * e.cn, std::sqrt(a / (I2 * (I3 - I2))) * e.sn,
                std::sqrt(b / (I3 * (I3 - I1))) * e.dn};
    }
};

/// The body's angular velocity from Omega of the box: xyz holds the vector (omega_yz, -omega_xz,
/// omega_xy), with the moments I_yz, I_xz, I_xy; by the sizes here I_yz < I_xz < I_xy.
Bivector from_vector(const Eigen::Vector3d& v) { return {v[2], -v[1], 0, v[0], 0, 0}; }

/// The formulas above must solve Euler's equations: I1 Omega_1' = (I2 - I3) Omega_2 Omega_3 and so
/// on around, here by central differences (h^2/6 times the third derivative: 1e-6 of it at most).
void check(const Racket& r) {
    constexpr double kStep = 1e-4;
    for (double t = 0; t < 3 * r.time_of_flip(); t += 0.0973) {
        const Eigen::Vector3d W = r.at(t);
        const Eigen::Vector3d rate = (r.at(t + kStep) - r.at(t - kStep)) / (2 * kStep);
        const Eigen::Vector3d euler{(r.I2 - r.I3) / r.I1 * W[1] * W[2],
                                    (r.I3 - r.I1) / r.I2 * W[2] * W[0],
                                    (r.I1 - r.I2) / r.I3 * W[0] * W[1]};
        if (!((rate - euler).norm() < 1e-6 * r.spin * r.spin))
            throw RunError(fmt::format("tennis racket: no solution at {} s", t));
    }
}

}  // namespace

/// The unstable axis: four flips, after each of which the box turns the other way in its frame.
Experiment tennis_racket(const Knobs& knobs) {
    const Vec4 J = kSize.cwiseAbs2() / 12;
    const Racket racket{
        .I1 = J[1] + J[2], .I2 = J[0] + J[2], .I3 = J[0] + J[1], .spin = 6, .push = 0.05};
    check(racket);
    const auto settings = settings_of(std::ceil(4 * racket.time_of_flip()), knobs, Vec4::Zero());
    const Bodies bodies = turning_box(from_vector(racket.at(0)));
    return {
        "tennis_racket", bodies, settings, [=](Trial& trial) -> std::vector<Error> {
            EnergyError energy_error(bodies);
            double worst = 0;
            trial.run([&](double time, const StepReport&) {
                const Bodies& now = trial.bodies();
                energy_error.see(now);
                const Bivector body = rotate(reverse(now.rotor[0]), now.angular_velocity[0]);
                worst = std::max(worst, norm(body - from_vector(racket.at(time))));
            });
            return {{"angular velocity", "relative", worst / racket.spin}, energy_error.error()};
        }};
}

}  // namespace tesserae::bench
