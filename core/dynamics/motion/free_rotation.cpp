// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/motion/free_rotation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "core/algebra/twin_quaternion.hpp"

namespace tesserae {
namespace {

/// Angle [rad] that one application of the midpoint rule turns at most; more is done in pieces.
/// Larger ones converge slowly, and the orientation's error is a sixth of the angle's square.
constexpr double kLargestAngle = 0.5;
/// Pieces of a turn at most. A turn by kMostTurn has a fourth of them, but a body's angular
/// velocity may grow while it turns.
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
/// where P0 is that at its start: dP/dt = [omega, P]/2. Of one body or of two, each as if alone.
template <class V>
class MiddleMomentum {
  public:
    /// @param inverse_inertia   a diagonal operator's entries
    MiddleMomentum(const Pairs<V>& inverse_inertia, const Pairs<V>& start, double h)
        : inverse_inertia_(inverse_inertia), start_(start), half_(0.5 * h) {
        const V momentum = largest_of_each(start);
        enough_ = 2 * std::numeric_limits<double>::epsilon() * momentum;
        // By which factor an iteration makes the error smaller, at least: the norm of half a
        // commutator is at most both norms times the root of two, that of P is about that of P0,
        // and a norm is at most the root of six times the largest component.
        const V shrinking = 8.5 * h * largest_of_each(inverse_inertia) * momentum;
        rest_ = simd::smaller(kFarBelow * shrinking, V{} + 1);
    }

    /// @return whether it has converged
    [[gnu::always_inline]] bool iterate(Pairs<V>& P) const {
        P = start_;
        auto done = V{} > V{};  // not yet
        for (int i = 0; i < kIterations; ++i) {
            const Pairs<V> change = error(P), next = P + change;
            if constexpr (std::is_same_v<V, Double2>)
                P = next;
            else
                P = {done ? P.x : next.x, done ? P.y : next.y, done ? P.z : next.z};
            done |= rest_ * largest_of_each(change) <= enough_;
            if (simd::in_all_lanes(done)) return true;
        }
        return false;
    }
    /// For slender bodies: the iteration diverges though the motion is smooth.
    [[gnu::noinline]] DualPlanes by_newton() const {
        DualPlanes P = start_;
        for (int i = 0; i < kNewtonSteps; ++i)
            if (newton_step(P)) break;
        const Vec6 x = to_vector(P);
        return x.allFinite() ? P : start_;
    }

  private:
    static constexpr int kIterations = 16, kNewtonSteps = 20;
    /// An iteration is left out only if it changes less than this part of what is enough: the same
    /// error in every step would add up.
    static constexpr double kFarBelow = 32;
    using Vec6 = Eigen::Matrix<double, 6, 1>;

    [[gnu::always_inline]] Pairs<V> error(const Pairs<V>& P) const {
        return (start_ - P) + half_ * half_commutator(scaled(inverse_inertia_, P), P);
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
        return x.cwiseAbs().maxCoeff() <= enough_[0];
    }
    static Vec6 to_vector(const DualPlanes& b) {
        return Vec6{b.x[0], b.y[0], b.z[0], b.x[1], b.y[1], b.z[1]};
    }
    static DualPlanes from_vector(const Vec6& x) {
        return {Double2{x[0], x[3]}, Double2{x[1], x[4]}, Double2{x[2], x[5]}};
    }

    const Pairs<V>& inverse_inertia_;
    const Pairs<V>& start_;
    double half_;
    V enough_, rest_;
};

/// By how much Cayley's map turns too little, as a turn about the momentum, which that does not
/// change: in each of the two quaternions, atan|u| instead of |u|. So that steady rotations are
/// exact. The quaternions of the turn given back may have to be scaled to unit length.
/// @return false: of one of two bodies it is not small
template <class V>
[[gnu::always_inline]] inline bool find_missing_turn(const Pairs<V>& half_turn,
                                                     const Pairs<V>& momentum, Twins<V>& missing) {
    const V squared = dot(half_turn, half_turn), length = dot(momentum, momentum);
    // In a quaternion without a momentum there is no turn.
    const V one = V{} + 1, along = dot(half_turn, momentum) / (length > 0 ? length : one);
    if (simd::largest_lane(squared) <= kSmallSquare) {
        // Of an angle below 3e-6, whose tangent it is.
        missing = {one, -(without_atan_of_small(squared) * along) * momentum};
        return true;
    }
    if constexpr (std::is_same_v<V, Double2>) {
        const TwinVector turn = (without_atan(squared) * along) * momentum;
        missing = to_twin(exp(-to_bivector(to_dual_planes(turn))));
        return true;
    }
    return false;
}

/// Of how many pieces a turn by an angle is put together.
double pieces_of(double angle_squared) {
    if (angle_squared <= kLargestAngle * kLargestAngle) return 1;
    return std::clamp(std::ceil(std::sqrt(angle_squared) / kLargestAngle), 1.0, kMostPieces);
}

/// One application of the midpoint rule, of one body or of two, each as if alone.
/// @param P   in the body frame
/// @return false: of one of two bodies it is not as simple; nothing has been changed
template <class V>
[[gnu::always_inline]] inline bool turn_piece(const Pairs<V>& inverse_inertia, double piece,
                                              Twins<V>& rotor, Pairs<V>& P) {
    const MiddleMomentum<V> momentum(inverse_inertia, P, piece);
    Pairs<V> middle;
    if (!momentum.iterate(middle)) {
        if constexpr (std::is_same_v<V, Double2>)
            middle = momentum.by_newton();
        else
            return false;
    }
    // With D = 1 + h/2 omega made a unit rotor, D P0 D~ = 2 P - P0 (Cayley's map in each of the two
    // quaternions), so that R D~ keeps the momentum in the world.
    const Pairs<V> half_turn = to_twin((0.5 * piece) * scaled(inverse_inertia, middle));
    const Pairs<V> end = middle + (middle - P), twin = to_twin(end);
    Twins<V> missing;
    if (!find_missing_turn(half_turn, twin, missing)) return false;
    P = end;
    rotor = normalized(rotor * Twins<V>{V{} + 1, -half_turn} * missing);
    return true;
}

/// The angular momentum in the body frame, and the angular velocity in the world.
template <class V>
[[gnu::always_inline]] inline Pairs<V> momentum_of(const Pairs<V>& inertia, const Twins<V>& rotor,
                                                   const Pairs<V>& omega) {
    return scaled(inertia, to_dual_planes(rotate_back(rotor, to_twin(omega))));
}
template <class V>
[[gnu::always_inline]] inline Pairs<V> velocity_of(const Pairs<V>& inverse_inertia,
                                                   const Twins<V>& rotor, const Pairs<V>& P) {
    return to_dual_planes(rotate(rotor, to_twin(scaled(inverse_inertia, P))));
}

/// exp of vectors whose squares are at most kSmallTurn, by the series: the next terms are below
/// 1e-19.
template <class V>
[[gnu::always_inline]] inline Twins<V> exp_of_small(const Pairs<V>& v, V squared) {
    const V& s = squared;
    const V sine = 1 - s * (1.0 / 6) * (1 - s * (1.0 / 20) * (1 - s * (1.0 / 42) * (1 - s / 72)));
    const V cosine = 1 - s * 0.5 * (1 - s * (1.0 / 12) * (1 - s * (1.0 / 30) * (1 - s / 56)));
    return {cosine, sine * v};
}
constexpr double kSmallTurn = 2.5e-3;

/// At a constant world angular velocity for a time h; of one body or of two, each as if alone.
/// @return false: it is not a small turn; nothing has been changed
template <class V>
[[gnu::always_inline]] inline bool turn_little(const Pairs<V>& omega, double h, Twins<V>& rotor) {
    const Pairs<V> v = to_twin((-0.5 * h) * omega);
    const V squared = dot(v, v);
    if (!(simd::largest_lane(squared) <= kSmallTurn)) return false;
    rotor = normalized(exp_of_small(v, squared) * rotor);
    return true;
}

void turn_evenly(double h, Rotor& body, const Bivector& omega) {
    TwinQuaternion rotor = to_twin(body);
    body = turn_little(to_dual_planes(omega), h, rotor) ? to_rotor(rotor) : turned(body, omega, h);
}

/// Of two bodies that turn little.
/// @return false: they do not; nothing has been changed
bool turn_both_evenly(const FreeBody& a, const FreeBody& b, double h) {
    if (a.omega == Bivector{} || b.omega == Bivector{}) return false;
    const TwinQuaternion rotor_a = to_twin(a.rotor), rotor_b = to_twin(b.rotor);
    Twins<Double4> rotor{beside(rotor_a.s, rotor_b.s), beside(rotor_a.v, rotor_b.v)};
    if (!turn_little(beside(to_dual_planes(a.omega), to_dual_planes(b.omega)), h, rotor))
        return false;
    a.rotor = to_rotor(TwinQuaternion{first_of(rotor.s), first_of(rotor.v)});
    b.rotor = to_rotor(TwinQuaternion{second_of(rotor.s), second_of(rotor.v)});
    return true;
}

/// Of principal axes, as principal_rotor() gives.
void put_principal(const TypeProperties& type, const Rotor& principal, Rotor& body) {
    body = type.has_axes ? projected_to_spin4(principal * reverse(type.axes)) : principal;
}

void turn_by_midpoint(const TypeProperties& type, double h, Rotor& body, Bivector& omega) {
    const DualPlanes inertia = to_dual_planes_unsigned(type.inertia);
    const DualPlanes inverse_inertia = to_dual_planes_unsigned(type.inverse_inertia);
    TwinQuaternion rotor = to_twin(principal_rotor(type, body));
    const double pieces = pieces_of(h * h * dot(omega, omega));
    const double piece = pieces == 1 ? h : h / pieces;  // the division would be waited for
    DualPlanes P = momentum_of(inertia, rotor, to_dual_planes(omega));
    for (double i = 0; i < pieces; ++i) turn_piece(inverse_inertia, piece, rotor, P);
    omega = to_bivector(velocity_of(inverse_inertia, rotor, P));
    put_principal(type, to_rotor(rotor), body);
}

/// Of two bodies that turn little.
/// @return false: they do not; nothing has been changed
bool turn_both_by_midpoint(const FreeBody& a, const FreeBody& b, double h) {
    const auto turns_little = [h](const FreeBody& body) {
        return body.omega != Bivector{} && pieces_of(h * h * dot(body.omega, body.omega)) == 1;
    };
    if (!turns_little(a) || !turns_little(b)) return false;
    const auto of_both = [](const Bivector& x, const Bivector& y) {
        return beside(to_dual_planes_unsigned(x), to_dual_planes_unsigned(y));
    };
    const Pairs<Double4> inverse_inertia = of_both(a.type.inverse_inertia, b.type.inverse_inertia);
    const TwinQuaternion rotor_a = to_twin(principal_rotor(a.type, a.rotor));
    const TwinQuaternion rotor_b = to_twin(principal_rotor(b.type, b.rotor));
    Twins<Double4> rotor{beside(rotor_a.s, rotor_b.s), beside(rotor_a.v, rotor_b.v)};
    Pairs<Double4> P = momentum_of(of_both(a.type.inertia, b.type.inertia), rotor,
                                   beside(to_dual_planes(a.omega), to_dual_planes(b.omega)));
    if (!turn_piece(inverse_inertia, h, rotor, P)) return false;
    const Pairs<Double4> omega = velocity_of(inverse_inertia, rotor, P);
    a.omega = to_bivector(first_of(omega));
    b.omega = to_bivector(second_of(omega));
    put_principal(a.type, to_rotor(TwinQuaternion{first_of(rotor.s), first_of(rotor.v)}), a.rotor);
    put_principal(b.type, to_rotor(TwinQuaternion{second_of(rotor.s), second_of(rotor.v)}),
                  b.rotor);
    return true;
}

}  // namespace

void turn_freely(const FreeBody& a, const FreeBody& b, RotationIntegrator integrator, double h) {
    if (a.type.isotropic && b.type.isotropic && turn_both_evenly(a, b, h)) return;
    if (integrator == RotationIntegrator::kMidpoint && !a.type.isotropic && !b.type.isotropic &&
        turn_both_by_midpoint(a, b, h))
        return;
    turn_freely(a.type, integrator, h, a.rotor, a.omega);
    turn_freely(b.type, integrator, h, b.rotor, b.omega);
}

double turning_time(const Bivector& omega, double h) {
    return h * h * dot(omega, omega) <= kMostTurn * kMostTurn ? h : kMostTurn / norm(omega);
}

void turn_freely(const TypeProperties& type, RotationIntegrator integrator, double h, Rotor& rotor,
                 Bivector& omega) {
    turn_on(type, integrator, turning_time(omega, h), rotor, omega);
}

void turn_on(const TypeProperties& type, RotationIntegrator integrator, double h, Rotor& rotor,
             Bivector& omega) {
    if (omega == Bivector{}) return;
    if (type.isotropic) {
        turn_evenly(h, rotor, omega);
    } else if (integrator == RotationIntegrator::kMidpoint) {
        turn_by_midpoint(type, h, rotor, omega);
    } else {
        const Bivector momentum = angular_momentum(type, rotor, omega);
        rotor = turned(rotor, omega, h);
        omega = angular_response(type, rotor, momentum);
    }
}

}  // namespace tesserae
