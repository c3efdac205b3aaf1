#pragma once

#include "core/algebra/bivector.hpp"

namespace tesserae {

/// A rotation of 4D space as an element s + B + p xyzw of the even algebra: v goes to R v R~.
/// Unit rotors (the group Spin(4)) obey two conditions, s^2 + |B|^2 + p^2 = 1 and 2 s p = B ^ B.
/// A body's rotor takes body coordinates to world coordinates. R and -R are the same rotation.
struct Rotor {
    double s = 1;
    Bivector b;
    double p = 0;

    friend bool operator==(const Rotor&, const Rotor&) = default;
    friend Rotor operator-(const Rotor& r) { return {-r.s, -r.b, -r.p}; }
};

/// A component of a unit rotor below this is rounding, not a sign: it counts as zero where R and -R
/// are told apart (in a few products of rotors 1e-15 gathers; 1e-12 rad is far below any picture).
constexpr double kRotorNoise = 1e-12;

/// Geometric product: the rotation b first, then a.
Rotor operator*(const Rotor& a, const Rotor& b);

/// R~, the inverse of a unit rotor.
inline Rotor reverse(const Rotor& r) { return {r.s, -r.b, r.p}; }

/// e^B. A rotation by angle t in the plane xy, turning x toward y, is exp(-t/2 xy): one whose world
/// angular velocity is omega for a time h is exp(-h/2 omega).
/// Every B has two invariant planes; the even algebra is a pair of quaternions whose angles are the
/// sum and the difference of the planes' angles, so equal angles (isoclinic) are no special case.
Rotor exp(const Bivector& b);

/// The B with exp(B) = r for a unit rotor, of least norm among those whose two quaternion angles
/// lie in [0, pi]. Where an angle is pi its direction is free: a fixed one is taken.
Bivector log(const Rotor& r);

/// The log of r or -r, the same rotation: of the shorter way there. At half turns, where two ways
/// are equally short, of the one whose first component of s, xy, ..., zw, p beyond kRotorNoise is
/// positive.
Bivector log_of_rotation(const Rotor& r);

/// The unit rotor nearest to a drifted one, on both conditions (rescaling alone mends only one).
/// Needs a rotor that is not a null element: s, B, p with |s^2 + |B|^2 + p^2| > |2 s p - B ^ B|.
Rotor projected_to_spin4(const Rotor& r);

/// R v R~ for all four axes: the rotation as an orthogonal matrix of determinant +1.
Mat4 to_matrix(const Rotor& r);

/// R y R~ for the unit vector y, where a capsule's core points: column 1 of to_matrix(r), without
/// the others. Inline, since it takes less time than a call that returns a vector in memory.
inline Vec4 y_axis_of(const Rotor& r) {
    // The product of the two quaternions of to_matrix(), one of them as a column.
    const Bivector& b = r.b;
    const double ps = r.s + r.p, px = b.xy - b.zw, py = b.xz + b.yw, pz = b.xw - b.yz;
    const double ms = r.s - r.p, mx = b.xy + b.zw, my = b.xz - b.yw, mz = b.xw + b.yz;
    return assembled(ps * mx + px * ms - py * mz + pz * my, ps * ms - px * mx + pz * mz + py * my,
                     pz * ms - py * mx - ps * mz - px * my, ps * my - pz * mx - py * ms - px * mz);
}

/// The rotor, up to sign, of an orthogonal matrix of determinant +1. The sign makes the first of
/// s, xy, ..., zw, p that is beyond kRotorNoise positive.
Rotor to_rotor(const Mat4& rotation);

/// R v R~.
inline Vec4 rotate(const Rotor& r, const Vec4& v) { return to_matrix(r) * v; }

/// R B R~: what the rotation does to planes.
Bivector rotate(const Rotor& r, const Bivector& b);

/// From r0 (t = 0) to r1 (t = 1) at constant angular velocity the shortest way, that of
/// log_of_rotation(r1 reverse(r0)).
Rotor interpolate(const Rotor& r0, const Rotor& r1, double t);

}  // namespace tesserae
