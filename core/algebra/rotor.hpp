// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/algebra/bivector.hpp"

namespace tesserae {

/// A Rotor is a rotation of 4D space, written as an element R = s + B + p xyzw of the even algebra.
/// It takes a vector v to R v R~. Unit rotors (the group Spin(4)) obey two conditions, s^2 + |B|^2
/// + p^2 = 1 and 2 s p = B ^ B. A body's rotor takes body coordinates to world coordinates. R and
/// -R are the same rotation.
struct Rotor {
    double s = 1;
    Bivector b;
    double p = 0;

    friend bool operator==(const Rotor&, const Rotor&) = default;
    friend Rotor operator-(const Rotor& r) { return {-r.s, -r.b, -r.p}; }
};

/// Components of a unit rotor up to this size count as zero where R and -R are told apart, usual
/// 1e-12: they are rounding and have no sign. Less, and the rounding of a few products (1e-15) may
/// choose the sign; more, and angles that matter are ignored (1e-12 rad is far below what a picture
/// shows).
constexpr double kRotorNoise = 1e-12;

/// Returns the geometric product a b, the rotation that turns by b first and then by a.
Rotor operator*(const Rotor& a, const Rotor& b);

/// Returns R~, which is the inverse of a unit rotor.
inline Rotor reverse(const Rotor& r) { return {r.s, -r.b, r.p}; }

/// Returns e^B. A rotation by an angle t in the plane xy, which turns x toward y, is exp(-t/2 xy).
/// A rotation at the world angular velocity omega for a time h is exp(-h/2 omega).
/// Every B has two invariant planes. The even algebra is a pair of quaternions whose angles are the
/// sum and the difference of the planes' angles, so equal angles (isoclinic) are no special case.
Rotor exp(const Bivector& b);

/// Returns the bivector B with exp(B) = r for a unit rotor r. It is the one of least norm among
/// those whose two quaternion angles lie in [0, pi]. Where an angle is pi, its direction is free,
/// and a fixed one is taken.
Bivector log(const Rotor& r);

/// Returns the logarithm of the rotation by the shorter way, which is that of r or of -r. At half
/// turns both ways are equally short. Then the one is taken whose first component of s, xy, ...,
/// zw, p beyond kRotorNoise is positive.
Bivector log_of_rotation(const Rotor& r);

/// Returns the unit rotor nearest to one that has drifted. It restores both conditions; rescaling
/// alone restores only one. The rotor must not be a null element: |s^2 + |B|^2 + p^2| > |2 s p - B
/// ^ B|.
Rotor projected_to_spin4(const Rotor& r);

/// Returns the rotation v -> R v R~ as an orthogonal matrix of determinant +1.
Mat4 to_matrix(const Rotor& r);

/// Returns R y R~ for the unit vector y, the direction of a capsule's core. It is column 1 of
/// to_matrix(r), without the others. It is inline because a call that returns a vector in memory
/// takes longer than the computation.
inline Vec4 y_axis_of(const Rotor& r) {
    // The product of the two quaternions of to_matrix(), one of them as a column.
    const Bivector& b = r.b;
    const double ps = r.s + r.p, px = b.xy - b.zw, py = b.xz + b.yw, pz = b.xw - b.yz;
    const double ms = r.s - r.p, mx = b.xy + b.zw, my = b.xz - b.yw, mz = b.xw + b.yz;
    return assembled(ps * mx + px * ms - py * mz + pz * my, ps * ms - px * mx + pz * mz + py * my,
                     pz * ms - py * mx - ps * mz - px * my, ps * my - pz * mx - py * ms - px * mz);
}

/// Returns a rotor of an orthogonal matrix of determinant +1. Its sign makes the first of s, xy,
/// ..., zw, p that is beyond kRotorNoise positive.
Rotor to_rotor(const Mat4& rotation);

/// Returns the rotated vector R v R~.
inline Vec4 rotate(const Rotor& r, const Vec4& v) { return to_matrix(r) * v; }

/// Returns the rotated bivector R B R~.
Bivector rotate(const Rotor& r, const Bivector& b);

/// Returns the rotor at t on the shortest way from r0 (t = 0) to r1 (t = 1) at constant angular
/// velocity. The way is that of log_of_rotation(r1 reverse(r0)).
Rotor interpolate(const Rotor& r0, const Rotor& r1, double t);

}  // namespace tesserae
