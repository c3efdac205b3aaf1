// SPDX-License-Identifier: Apache-2.0
#include "core/dynamics/constraints/frame_joint.hpp"

#include <cmath>
#include <numbers>

namespace tesserae {
namespace {

double product(const Rotor& x, const Rotor& y) { return x.s * y.s + dot(x.b, y.b) + x.p * y.p; }

struct Frames {
    Rotor a, turn;  ///< a's axes to the world; the rotation from a's axes to b's
    Vec4 between;   ///< from a's origin to b's, world [m]
    Vec4 on_b;      ///< b's origin, world [m]
};

Frames frames_of(const FrameJoint& joint, const JointedBody& a, const JointedBody& b) {
    Frames frames;
    frames.a = a.rotor * joint.axes_a;
    frames.turn = reverse(frames.a) * (b.rotor * joint.axes_b);
    frames.on_b = b.position + rotate(b.rotor, joint.on_b);
    frames.between = frames.on_b - (a.position + rotate(a.rotor, joint.on_a));
    return frames;
}

RowVector values_of(const Frames& frames, const Bivector& angles) {
    RowVector values(10);
    values << to_matrix(frames.a).transpose() * frames.between, angles.xy, angles.xz, angles.xw,
        angles.yz, angles.yw, angles.zw;
    return values;
}

/// The part of the second term of the logarithm's derivative: (1 - x cot x) / (2 x)^2, 2 x = angle.
double second_term(double angle) {
    if (angle < 1e-2) return 1.0 / 12 + angle * angle / 720;
    return (1 - 0.5 * angle / std::tan(0.5 * angle)) / (angle * angle);
}

/// Takes a unit angle's gradient: the bivector whose product with the angular velocity, both in a's
/// axes, is the angle's derivative. Both halves of a bivector, which commute, turn on their own.
class AngleGradient {
  public:
    explicit AngleGradient(const Bivector& angles) {
        for (const double sign : {1.0, -1.0}) {
            Half& half = halves_[sign > 0 ? 0 : 1];
            half.angles = 0.5 * (angles + sign * dual(angles));
            half.term = second_term(std::numbers::sqrt2 * norm(half.angles));
        }
        angles_ = angles;
    }

    Bivector of(const Bivector& unit) const {
        Bivector sum = unit - 0.5 * half_commutator(angles_, unit);
        for (const Half& half : halves_)
            sum += half.term * half_commutator(half.angles, half_commutator(half.angles, unit));
        return sum;
    }

  private:
    struct Half {
        Bivector angles;
        double term = 0;
    };
    std::array<Half, 2> halves_;
    Bivector angles_;
};

}  // namespace

RowVector values_of(const FrameJoint& joint, const JointedBody& a, const JointedBody& b,
                    const Rotor& near) {
    const Frames frames = frames_of(joint, a, b);
    const Rotor& turn = frames.turn;
    return values_of(frames, -2.0 * log(product(turn, near) < 0 ? -turn : turn));
}

Coordinates coordinates_of(const FrameJoint& joint, const JointedBody& a, const JointedBody& b) {
    const Frames frames = frames_of(joint, a, b);
    const Bivector half_angles = log_of_rotation(frames.turn);
    Coordinates all;
    all.size = kMostRows;
    all.values = values_of(frames, -2.0 * half_angles);
    all.turn = exp(half_angles);
    all.anchor = frames.on_b;
    const Mat4 axes = to_matrix(frames.a);
    for (int axis = 0; axis < 4; ++axis)
        all.rows[static_cast<std::size_t>(axis)] = {axes.col(axis), {}};
    const AngleGradient gradient(-2.0 * half_angles);
    constexpr double Bivector::*kPlanes[] = {&Bivector::xy, &Bivector::xz, &Bivector::xw,
                                             &Bivector::yz, &Bivector::yw, &Bivector::zw};
    for (std::size_t plane = 0; plane < 6; ++plane) {
        Bivector unit;
        unit.*kPlanes[plane] = 1;
        all.rows[4 + plane] = {Vec4::Zero(), rotate(frames.a, gradient.of(unit))};
    }
    return all;
}

}  // namespace tesserae
