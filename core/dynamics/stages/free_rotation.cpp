#include "core/dynamics/stages/free_rotation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/algebra/twin_quaternion.hpp"

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

/// The series of 1 - atan(angle) / angle by the angle's square, of one angle or two.
template <class V>
[[gnu::always_inline]] inline V without_atan_of_small(V squared) {
    return squared * (1.0 / 3 - squared * (1.0 / 5 - squared * (1.0 / 7 - squared * (1.0 / 9))));
}
/// To this square the next term of the series, times the angle, is below 1e-19.
constexpr double kSmallSquare = 4e-4;

/// 1 - atan(angle) / angle of two angles, by their squares.
Double2 without_atan(Double2 squared) {
    const auto of_one = [](double square) {
        if (square <= kSmallSquare) return without_atan_of_small(square);
        const double angle = std::sqrt(square);
        return (angle - std::atan(angle)) / angle;
    };
    return Double2{of_one(squared[0]), of_one(squared[1])};
}

/// The body-frame angular momentum in the middle of a piece of length h, P = P0 + h/2 [I^-1 P, P]/2
/// where P0 is that at its start: dP/dt = [omega, P]/2.
class MiddleMomentum {
  public:
    /// @param inverse_inertia   a diagonal operator's entries
    MiddleMomentum(const DualPlanes& inverse_inertia, const DualPlanes& start, double h)
        : inverse_inertia_(inverse_inertia), start_(start), half_(0.5 * h) {
        const double momentum = largest_of(start);
        enough_ = 2 * std::numeric_limits<double>::epsilon() * momentum;
        // By which factor an iteration makes the error smaller, at least: the norm of half a
        // commutator is at most both norms times the root of two, that of P is about that of P0,
        // and a norm is at most the root of six times the largest component.
        const double shrinking = 8.5 * h * largest_of(inverse_inertia) * momentum;
        rest_ = std::min(1.0, kFarBelow * shrinking);
    }

    [[gnu::always_inline]] DualPlanes solve() const {
        DualPlanes P = start_;
        for (int i = 0; i < kIterations; ++i) {
            const DualPlanes change = error(P);
            P = P + change;
            if (rest_ * largest_of(change) <= enough_) return P;
        }
        return solve_by_newton();
    }

  private:
    static constexpr int kIterations = 16, kNewtonSteps = 20;
    /// An iteration is left out only if it changes less than this part of what is enough: the same
    /// error in every step would add up.
    static constexpr double kFarBelow = 32;
    using Vec6 = Eigen::Matrix<double, 6, 1>;

    [[gnu::always_inline]] DualPlanes error(const DualPlanes& P) const {
        return (start_ - P) + half_ * half_commutator(scaled(inverse_inertia_, P), P);
    }

    /// For slender bodies: the iteration diverges though the motion is smooth.
    [[gnu::noinline]] DualPlanes solve_by_newton() const {
        DualPlanes P = start_;
        for (int i = 0; i < kNewtonSteps; ++i)
            if (newton_step(P)) break;
        const Vec6 x = to_vector(P);
        return x.allFinite() ? P : start_;
    }
    /// Whether it has converged.
    bool newton_step(DualPlanes& P) const {
        const DualPlanes omega = scaled(inverse_inertia_, P);
        Eigen::Matrix<double, 6, 6> slope;
        for (int i = 0; i < 6; ++i) {
            const DualPlanes unit = from_vector(Vec6::Unit(i));
            const DualPlanes change =
                half_commutator(scaled(inverse_inertia_, unit), P) + half_commutator(omega, unit);
            slope.col(i) = to_vector(unit - half_ * change);
        }
        const Vec6 x = slope.partialPivLu().solve(to_vector(error(P)));
        P = P + from_vector(x);
        return x.cwiseAbs().maxCoeff() <= enough_;
    }
    static Vec6 to_vector(const DualPlanes& b) {
        return Vec6{b.x[0], b.y[0], b.z[0], b.x[1], b.y[1], b.z[1]};
    }
    static DualPlanes from_vector(const Vec6& x) {
        return {Double2{x[0], x[3]}, Double2{x[1], x[4]}, Double2{x[2], x[5]}};
    }

    const DualPlanes& inverse_inertia_;
    const DualPlanes& start_;
    double half_, enough_, rest_;
};

/// By how much Cayley's map turns too little, as a turn about the momentum, which that does not
/// change: in each of the two quaternions, atan|u| instead of |u|. So that steady rotations are
/// exact. The quaternions of the turn given back may have to be scaled to unit length.
[[gnu::always_inline]] inline TwinQuaternion missing_turn(const TwinVector& half_turn,
                                                          const TwinVector& momentum) {
    const Double2 squared = dot(half_turn, half_turn), length = dot(momentum, momentum);
    // In a quaternion without a momentum there is no turn.
    const Double2 one{1, 1}, along = dot(half_turn, momentum) / (length > 0 ? length : one);
    if (simd::largest_lane(squared) <= kSmallSquare) {
        // Of an angle below 3e-6, whose tangent it is.
        return {one, -(without_atan_of_small(squared) * along) * momentum};
    }
    const TwinVector missing = (without_atan(squared) * along) * momentum;
    return to_twin(exp(-to_bivector(to_dual_planes(missing))));
}

/// Of how many pieces a turn by an angle is put together.
double pieces_of(double angle_squared) {
    if (angle_squared <= kLargestAngle * kLargestAngle) return 1;
    return std::clamp(std::ceil(std::sqrt(angle_squared) / kLargestAngle), 1.0, kMostPieces);
}

void turn_by_midpoint(const TypeProperties& type, double h, Rotor& body, Bivector& omega) {
    const DualPlanes inertia = to_dual_planes_unsigned(type.inertia);
    const DualPlanes inverse_inertia = to_dual_planes_unsigned(type.inverse_inertia);
    TwinQuaternion rotor = to_twin(principal_rotor(type, body));
    const double pieces = pieces_of(h * h * dot(omega, omega));
    const double piece = pieces == 1 ? h : h / pieces;  // the division would be waited for
    DualPlanes P =
        scaled(inertia, to_dual_planes(rotate_back(rotor, to_twin(to_dual_planes(omega)))));
    for (double i = 0; i < pieces; ++i) {
        const DualPlanes middle = MiddleMomentum(inverse_inertia, P, piece).solve();
        // With D = 1 + h/2 omega made a unit rotor, D P0 D~ = 2 P - P0 (Cayley's map in each of the
        // two quaternions), so that R D~ keeps the momentum in the world.
        const TwinVector half_turn = to_twin((0.5 * piece) * scaled(inverse_inertia, middle));
        P = middle + (middle - P);
        const TwinQuaternion turn{Double2{1, 1}, -half_turn};
        rotor = normalized(rotor * turn * missing_turn(half_turn, to_twin(P)));
    }
    omega = to_bivector(to_dual_planes(rotate(rotor, to_twin(scaled(inverse_inertia, P)))));
    body = to_rotor(rotor);
    if (type.has_axes) body = projected_to_spin4(body * reverse(type.axes));
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
