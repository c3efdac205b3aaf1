// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "core/algebra/vector.hpp"

namespace tesserae {

/// A Bivector is an oriented plane element of 4D space. It holds an angular velocity [rad/s], an
/// angular momentum, a torque, or the plane and angle of a rotation. Its components are in the
/// order xy, xz, xw, yz, yw, zw, the only order used anywhere.
struct Bivector {
    double xy = 0, xz = 0, xw = 0, yz = 0, yw = 0, zw = 0;

    friend bool operator==(const Bivector&, const Bivector&) = default;
    Bivector& operator+=(const Bivector& o) {
        xy += o.xy, xz += o.xz, xw += o.xw, yz += o.yz, yw += o.yw, zw += o.zw;
        return *this;
    }
    friend Bivector operator+(Bivector a, const Bivector& b) { return a += b; }
    friend Bivector operator*(double k, const Bivector& b) {
        return {k * b.xy, k * b.xz, k * b.xw, k * b.yz, k * b.yw, k * b.zw};
    }
    friend Bivector operator-(const Bivector& b) { return -1.0 * b; }
    friend Bivector operator-(const Bivector& a, const Bivector& b) { return a + (-b); }
};

/// Returns the sum of the products of the six components. The dot product of a torque and an
/// angular velocity is a power.
inline double dot(const Bivector& a, const Bivector& b) {
    return a.xy * b.xy + a.xz * b.xz + a.xw * b.xw + a.yz * b.yz + a.yw * b.yw + a.zw * b.zw;
}

inline double norm(const Bivector& b) { return std::sqrt(dot(b, b)); }

/// Multiplies component by component. This applies a diagonal operator, such as the inertia in the
/// body frame.
inline Bivector scaled(const Bivector& a, const Bivector& b) {
    return {a.xy * b.xy, a.xz * b.xz, a.xw * b.xw, a.yz * b.yz, a.yw * b.yw, a.zw * b.zw};
}

/// Returns the outer product a ^ b, the oriented area that a and b span. r ^ f is the torque of a
/// force f that acts at r.
inline Bivector wedge(const Vec4& a, const Vec4& b) {
    return {a[0] * b[1] - a[1] * b[0], a[0] * b[2] - a[2] * b[0], a[0] * b[3] - a[3] * b[0],
            a[1] * b[2] - a[2] * b[1], a[1] * b[3] - a[3] * b[1], a[2] * b[3] - a[3] * b[2]};
}

/// Returns the xyzw coefficient of a ^ b. It is zero for a = b exactly when b is simple, that is,
/// lies in a single plane.
inline double wedge(const Bivector& a, const Bivector& b) {
    return a.xy * b.zw + a.zw * b.xy - a.xz * b.yw - a.yw * b.xz + a.xw * b.yz + a.yz * b.xw;
}

/// Returns (a b - b a) / 2, which is a bivector. A constant B, seen from a body that turns with
/// omega, changes by dB/dt = half_commutator(omega, B).
inline Bivector half_commutator(const Bivector& a, const Bivector& b) {
    return {a.yz * b.xz - a.xz * b.yz + a.yw * b.xw - a.xw * b.yw,
            a.xy * b.yz - a.yz * b.xy + a.zw * b.xw - a.xw * b.zw,
            a.xy * b.yw - a.yw * b.xy + a.xz * b.zw - a.zw * b.xz,
            a.xz * b.xy - a.xy * b.xz + a.zw * b.yw - a.yw * b.zw,
            a.xw * b.xy - a.xy * b.xw + a.yz * b.zw - a.zw * b.yz,
            a.xw * b.xz - a.xz * b.xw + a.yw * b.yz - a.yz * b.yw};
}

/// Returns the product B xyzw, which is the plane orthogonal to B. dual(dual(B)) = B.
inline Bivector dual(const Bivector& b) { return {-b.zw, b.yw, -b.yz, -b.xw, b.xz, -b.xy}; }

/// Returns the velocity [m/s] of the point at offset r [m] of a body that turns with omega [rad/s].
/// A positive omega.xy turns x toward y.
inline Vec4 velocity_at(const Bivector& omega, const Vec4& r) {
    return assembled(-omega.xy * r[1] - omega.xz * r[2] - omega.xw * r[3],
                     omega.xy * r[0] - omega.yz * r[2] - omega.yw * r[3],
                     omega.xz * r[0] + omega.yz * r[1] - omega.zw * r[3],
                     omega.xw * r[0] + omega.yw * r[1] + omega.zw * r[2]);
}

/// Returns the antisymmetric matrix that maps r to velocity_at(b, r). Its entry [y][x] is b.xy.
inline Mat4 to_matrix(const Bivector& b) {
    Mat4 m;
    m << 0, -b.xy, -b.xz, -b.xw,  //
        b.xy, 0, -b.yz, -b.yw,    //
        b.xz, b.yz, 0, -b.zw,     //
        b.xw, b.yw, b.zw, 0;
    return m;
}

/// Returns the bivector whose matrix is the antisymmetric part of m.
inline Bivector to_bivector(const Mat4& m) {
    return 0.5 * Bivector{m(1, 0) - m(0, 1), m(2, 0) - m(0, 2), m(3, 0) - m(0, 3),
                          m(2, 1) - m(1, 2), m(3, 1) - m(1, 3), m(3, 2) - m(2, 3)};
}

}  // namespace tesserae
