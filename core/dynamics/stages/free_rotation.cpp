#include "core/dynamics/stages/free_rotation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tesserae {
namespace {

/// Angle [rad] that one application of the midpoint rule turns at most; more is done in pieces.
/// Larger ones converge slowly, and the orientation's error is a sixth of the angle's square.
constexpr double kLargestAngle = 0.5;
/// Pieces of a turn at most; beyond, at angular velocities that no step resolves, only the angular
/// momentum stays.
constexpr double kMostPieces = 1000;

/// The rotor after turning at a constant world angular velocity for a time h.
Rotor turned(const Rotor& rotor, const Bivector& omega, double h) {
    return projected_to_spin4(exp(-0.5 * h * omega) * rotor);
}

double largest_of(const Bivector& b) {
    return std::max({std::abs(b.xy), std::abs(b.xz), std::abs(b.xw), std::abs(b.yz), std::abs(b.yw),
                     std::abs(b.zw)});
}

/// The body-frame angular momentum in the middle of a piece of length h, P = P0 + h/2 [I^-1 P, P]/2
/// where P0 is that at its start: dP/dt = [omega, P]/2.
class MiddleMomentum {
  public:
    MiddleMomentum(const Bivector& inverse_inertia, const Bivector& start, double h)
        : inverse_inertia_(inverse_inertia),
          start_(start),
          half_(0.5 * h),
          enough_(2 * std::numeric_limits<double>::epsilon() * largest_of(start)) {}

    Bivector solve() const {
        Bivector P = start_;
        if (iterate(P)) return P;
        // Slender bodies: the iteration diverges though the motion is smooth.
        P = start_;
        for (int i = 0; i < kNewtonSteps; ++i)
            if (newton_step(P)) break;
        return std::isfinite(largest_of(P)) ? P : start_;
    }

  private:
    static constexpr int kIterations = 16, kNewtonSteps = 20;
    using Vec6 = Eigen::Matrix<double, 6, 1>;

    Bivector error(const Bivector& P) const {
        return start_ + half_ * half_commutator(scaled(inverse_inertia_, P), P) - P;
    }
    /// Whether it has converged.
    bool iterate(Bivector& P) const {
        for (int i = 0; i < kIterations; ++i) {
            const Bivector change = error(P);
            P += change;
            if (largest_of(change) <= enough_) return true;
        }
        return false;
    }
    bool newton_step(Bivector& P) const {
        const Bivector omega = scaled(inverse_inertia_, P);
        Eigen::Matrix<double, 6, 6> slope;
        for (int i = 0; i < 6; ++i) {
            Bivector unit;
            double* const components[] = {&unit.xy, &unit.xz, &unit.xw,
                                          &unit.yz, &unit.yw, &unit.zw};
            *components[i] = 1;
            const Bivector change =
                half_commutator(scaled(inverse_inertia_, unit), P) + half_commutator(omega, unit);
            slope.col(i) = to_vector(unit - half_ * change);
        }
        const Vec6 x = slope.partialPivLu().solve(to_vector(error(P)));
        P += Bivector{x[0], x[1], x[2], x[3], x[4], x[5]};
        return x.cwiseAbs().maxCoeff() <= enough_;
    }
    static Vec6 to_vector(const Bivector& b) { return Vec6{b.xy, b.xz, b.xw, b.yz, b.yw, b.zw}; }

    const Bivector& inverse_inertia_;
    const Bivector& start_;
    double half_, enough_;
};

/// angle - atan(angle) of an angle >= 0.
double less_its_atan(double angle) {
    if (angle > 0.02) return angle - std::atan(angle);
    // The series' next term is below 1e-19.
    const double squared = angle * angle;
    return angle * squared *
           (1.0 / 3 - squared * (1.0 / 5 - squared * (1.0 / 7 - squared * (1.0 / 9))));
}

/// By how much Cayley's map turns too little, as a turn about the momentum, which that does not
/// change: in each of the two quaternions, atan|u| instead of |u|. So that steady rotations are
/// exact.
Bivector missing_turn(const Bivector& half_turn, const Bivector& momentum) {
    Bivector missing;
    for (const double sign : {1.0, -1.0}) {
        // The part in one quaternion, whose norm is by the root of two larger than the bivector's.
        const auto part = [&](const Bivector& b) { return 0.5 * (b + sign * dual(b)); };
        const Bivector u = part(half_turn), P = part(momentum);
        const double squared = dot(u, u) * dot(P, P);
        if (!(squared > 0)) continue;
        const double angle = std::numbers::sqrt2 * norm(u);
        const double cosine = dot(u, P) / std::sqrt(squared);
        missing += less_its_atan(angle) * cosine / (std::numbers::sqrt2 * norm(P)) * P;
    }
    return missing;
}

void turn_by_midpoint(const TypeProperties& type, double h, Rotor& body, Bivector& omega) {
    Rotor rotor = principal_rotor(type, body);
    const Bivector omega_body = rotate(reverse(rotor), omega);
    const double pieces = std::clamp(std::ceil(h * norm(omega) / kLargestAngle), 1.0, kMostPieces);
    const double piece = h / pieces;
    Bivector P = scaled(type.inertia, omega_body);
    for (double i = 0; i < pieces; ++i) {
        const Bivector middle = MiddleMomentum(type.inverse_inertia, P, piece).solve();
        // With D = 1 + h/2 omega made a unit rotor, D P0 D~ = 2 P - P0 (Cayley's map in each of the
        // two quaternions), so that R D~ keeps the momentum in the world.
        const Bivector half_turn = (0.5 * piece) * scaled(type.inverse_inertia, middle);
        P = middle + (middle - P);
        rotor =
            projected_to_spin4(rotor * Rotor{1, -half_turn, 0} * exp(-missing_turn(half_turn, P)));
    }
    omega = rotate(rotor, scaled(type.inverse_inertia, P));
    body = type.has_axes ? projected_to_spin4(rotor * reverse(type.axes)) : rotor;
}

}  // namespace

void turn_freely(const TypeProperties& type, RotationIntegrator integrator, double h, Rotor& rotor,
                 Bivector& omega) {
    if (omega == Bivector{}) return;
    if (type.isotropic) {
        rotor = turned(rotor, omega, h);
    } else if (integrator == RotationIntegrator::kMidpoint) {
        turn_by_midpoint(type, h, rotor, omega);
    } else {
        const Bivector momentum = angular_momentum(type, rotor, omega);
        rotor = turned(rotor, omega, h);
        omega = angular_response(type, rotor, momentum);
    }
}

}  // namespace tesserae
