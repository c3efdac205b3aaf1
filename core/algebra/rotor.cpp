// SPDX-License-Identifier: Apache-2.0
#include "core/algebra/rotor.hpp"

#include <cmath>

namespace tesserae {
namespace {

/// The even algebra splits into two ideals, (1 + I)/2 and (1 - I)/2 times it with I = xyzw, each of
/// them a copy of the quaternions. Components of one copy: scalar, then the coefficients of
/// xy -+ zw, xz +- yw, xw -+ yz.
struct Quaternion {
    double s, x, y, z;

    double vector_norm() const { return stable_norm({x, y, z, 0}); }
};
struct QuaternionPair {
    Quaternion plus, minus;
};

QuaternionPair to_pair(const Rotor& r) {
    return {{r.s + r.p, r.b.xy - r.b.zw, r.b.xz + r.b.yw, r.b.xw - r.b.yz},
            {r.s - r.p, r.b.xy + r.b.zw, r.b.xz - r.b.yw, r.b.xw + r.b.yz}};
}

Rotor from_pair(const QuaternionPair& q) {
    const auto& [a, b] = q;
    return {0.5 * (a.s + b.s),
            {0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z), 0.5 * (b.z - a.z),
             0.5 * (a.y - b.y), 0.5 * (b.x - a.x)},
            0.5 * (a.s - b.s)};
}

/// Angles below this have few terms [rad]; squares above this are not rounded as tiny numbers are.
constexpr double kSmallAngle = 2e-3, kNormalSquare = 1e-290;

/// q v q~ of a v without scalar. In the one copy x y = kSign z, in the other its negative.
template <int kSign>
Quaternion turned(const Quaternion& q, const Quaternion& v) {
    const double squares = q.s * q.s - (q.x * q.x + q.y * q.y + q.z * q.z);
    const double along = 2 * (q.x * v.x + q.y * v.y + q.z * v.z), across = 2 * kSign * q.s;
    return {0, squares * v.x + along * q.x + across * (q.y * v.z - q.z * v.y),
            squares * v.y + along * q.y + across * (q.z * v.x - q.x * v.z),
            squares * v.z + along * q.z + across * (q.x * v.y - q.y * v.x)};
}

Quaternion exp(const Quaternion& v) {
    const double squared = v.x * v.x + v.y * v.y + v.z * v.z;
    if (squared < kSmallAngle * kSmallAngle && squared > kNormalSquare) {
        // The series' next terms are below 1e-17 of these.
        const double k = 1 - squared / 6 * (1 - squared / 20);
        return {1 - squared / 2 * (1 - squared / 12), k * v.x, k * v.y, k * v.z};
    }
    const double angle = v.vector_norm();
    const double k = angle > 0 ? std::sin(angle) / angle : 1.0;
    return {std::cos(angle), k * v.x, k * v.y, k * v.z};
}

Quaternion log(const Quaternion& q) {
    const double sine = q.vector_norm();
    const double angle = std::atan2(sine, q.s);
    if (sine == 0) return {0, angle, 0, 0};  // 0, or pi about an axis of our choice
    const double k = angle / sine;
    return {0, k * q.x, k * q.y, k * q.z};
}

Quaternion normalized(const Quaternion& q) {
    const double k = 1.0 / std::sqrt(q.s * q.s + q.x * q.x + q.y * q.y + q.z * q.z);
    return {k * q.s, k * q.x, k * q.y, k * q.z};
}

/// The sign rule that makes a choice between R and -R the same everywhere.
bool first_nonzero_is_negative(const Rotor& r) {
    for (double c : {r.s, r.b.xy, r.b.xz, r.b.xw, r.b.yz, r.b.yw, r.b.zw, r.p})
        if (std::abs(c) > kRotorNoise) return c < 0;
    return false;
}

/// Matrices of the rotation that one quaternion of the pair stands for, the other being 1: its
/// scalar times 1, less the matrix of its bivector.
Mat4 plus_matrix(const Quaternion& q) {
    Mat4 m;
    m.col(0) = assembled(q.s, -q.x, -q.y, -q.z);
    m.col(1) = assembled(q.x, q.s, q.z, -q.y);
    m.col(2) = assembled(q.y, -q.z, q.s, q.x);
    m.col(3) = assembled(q.z, q.y, -q.x, q.s);
    return m;
}
Mat4 minus_matrix(const Quaternion& q) {
    Mat4 m;
    m.col(0) = assembled(q.s, -q.x, -q.y, -q.z);
    m.col(1) = assembled(q.x, q.s, -q.z, q.y);
    m.col(2) = assembled(q.y, q.z, q.s, -q.x);
    m.col(3) = assembled(q.z, -q.y, q.x, q.s);
    return m;
}

}  // namespace

Rotor operator*(const Rotor& a, const Rotor& b) {
    // B1 B2 = -B1.B2 + (half the commutator) + B1 ^ B2, and I commutes with all of it, I I = 1.
    const Bivector &u = a.b, &v = b.b;
    return {a.s * b.s - dot(u, v) + a.p * b.p,
            a.s * v + b.s * u + half_commutator(u, v) + a.p * dual(v) + b.p * dual(u),
            a.s * b.p + a.p * b.s + wedge(u, v)};
}

Rotor exp(const Bivector& b) {
    const QuaternionPair v = to_pair({0, b, 0});
    return from_pair({exp(v.plus), exp(v.minus)});
}

Bivector log(const Rotor& r) {
    const QuaternionPair q = to_pair(r);
    return from_pair({log(q.plus), log(q.minus)}).b;
}

Rotor projected_to_spin4(const Rotor& r) {
    // Normalising both quaternions is R <- (u + v I)^-1 R of core/FORMULAS.md 1, without its
    // cancellations.
    const QuaternionPair q = to_pair(r);
    return from_pair({normalized(q.plus), normalized(q.minus)});
}

Mat4 to_matrix(const Rotor& r) {
    const QuaternionPair q = to_pair(r);
    return plus_matrix(q.plus) * minus_matrix(q.minus);
}

Rotor to_rotor(const Mat4& rotation) {
    // The 16 products of the two matrix families are orthogonal, so the rotation's components along
    // them are the outer product of the two quaternions. Its largest row gives one of them.
    using Row = Eigen::RowVector4d;
    Mat4 outer;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            const Vec4 e = Vec4::Unit(i), f = Vec4::Unit(j);
            const Mat4 basis =
                plus_matrix({e[0], e[1], e[2], e[3]}) * minus_matrix({f[0], f[1], f[2], f[3]});
            outer(i, j) = 0.25 * rotation.cwiseProduct(basis).sum();
        }
    int row;
    outer.rowwise().squaredNorm().maxCoeff(&row);
    const Row minus = outer.row(row).normalized();
    const Vec4 plus = (outer * minus.transpose()).normalized();
    const Rotor r =
        from_pair({{plus[0], plus[1], plus[2], plus[3]}, {minus[0], minus[1], minus[2], minus[3]}});
    return first_nonzero_is_negative(r) ? -r : r;
}

Bivector rotate(const Rotor& r, const Bivector& b) {
    const QuaternionPair q = to_pair(r), v = to_pair({0, b, 0});
    return from_pair({turned<1>(q.plus, v.plus), turned<-1>(q.minus, v.minus)}).b;
}

Bivector log_of_rotation(const Rotor& r) {
    // With quaternion angles a and b, s = cos((a + b)/2) cos((a - b)/2); those of -r are pi - a and
    // pi - b. So the shorter way, the one with a + b <= pi, is the one with s >= 0.
    return log(first_nonzero_is_negative(r) ? -r : r);
}

Rotor interpolate(const Rotor& r0, const Rotor& r1, double t) {
    return exp(t * log_of_rotation(r1 * reverse(r0))) * r0;
}

}  // namespace tesserae
