// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "core/algebra/rotor.hpp"
#include "core/simd/simd.hpp"

// This header holds bivectors and rotors as pairs of numbers that undergo the same operations. Each
// CPU instruction then works on two numbers, or on the four of two bodies. A rotor is two
// quaternions, and a bivector is their vector parts (rotor.cpp). The vector part of the second
// quaternion is stored with the opposite sign, so that both multiply alike.
//
// All functions are inlined: passed in memory, the pairs would have to be assembled again from
// single numbers.
namespace tesserae {

using simd::Double2, simd::Double4;

/// Holds three pairs of numbers.
/// @tparam V   Double2 for one body; Double4 for two, a pair of each
template <class V>
struct Pairs {
    V x, y, z;

    friend Pairs operator+(const Pairs& a, const Pairs& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend Pairs operator-(const Pairs& a, const Pairs& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend Pairs operator-(const Pairs& a) { return {-a.x, -a.y, -a.z}; }
    friend Pairs operator*(V k, const Pairs& a) { return {k * a.x, k * a.y, k * a.z}; }
    friend Pairs operator*(double k, const Pairs& a) { return {k * a.x, k * a.y, k * a.z}; }
};
using ThreePairs = Pairs<Double2>;

/// DualPlanes is a bivector with each plane beside the orthogonal one: (xy, zw), (xz, wy), (xw,
/// yz).
using DualPlanes = ThreePairs;
/// A TwinVector is the vector parts of two quaternions, side by side.
using TwinVector = ThreePairs;

/// Holds two quaternions: scalars s and vectors v, with x y = z in both.
template <class V>
struct Twins {
    V s;
    Pairs<V> v;
};
using TwinQuaternion = Twins<Double2>;

/// Returns each pair with its two numbers exchanged.
[[gnu::always_inline]] inline Double2 swapped(Double2 a) {
    return __builtin_shufflevector(a, a, 1, 0);
}
[[gnu::always_inline]] inline Double2 first_twice(Double2 a) {
    return __builtin_shufflevector(a, a, 0, 0);
}
[[gnu::always_inline]] inline Double2 second_twice(Double2 a) {
    return __builtin_shufflevector(a, a, 1, 1);
}
[[gnu::always_inline]] inline Double4 swapped(Double4 a) {
    return __builtin_shufflevector(a, a, 1, 0, 3, 2);
}
[[gnu::always_inline]] inline Double4 first_twice(Double4 a) {
    return __builtin_shufflevector(a, a, 0, 0, 2, 2);
}
[[gnu::always_inline]] inline Double4 second_twice(Double4 a) {
    return __builtin_shufflevector(a, a, 1, 1, 3, 3);
}
/// Returns each pair with the sign of its second number changed.
[[gnu::always_inline]] inline Double2 second_negated(Double2 a) { return a * Double2{1, -1}; }
[[gnu::always_inline]] inline Double4 second_negated(Double4 a) {
    return a * Double4{1, -1, 1, -1};
}

/// Puts two pairs side by side. first_of() and second_of() return them.
[[gnu::always_inline]] inline Double4 beside(Double2 a, Double2 b) {
    return __builtin_shufflevector(a, b, 0, 1, 2, 3);
}
[[gnu::always_inline]] inline Double2 first_of(Double4 a) {
    return __builtin_shufflevector(a, a, 0, 1);
}
[[gnu::always_inline]] inline Double2 second_of(Double4 a) {
    return __builtin_shufflevector(a, a, 2, 3);
}
[[gnu::always_inline]] inline Pairs<Double4> beside(const ThreePairs& a, const ThreePairs& b) {
    return {beside(a.x, b.x), beside(a.y, b.y), beside(a.z, b.z)};
}
[[gnu::always_inline]] inline ThreePairs first_of(const Pairs<Double4>& a) {
    return {first_of(a.x), first_of(a.y), first_of(a.z)};
}
[[gnu::always_inline]] inline ThreePairs second_of(const Pairs<Double4>& a) {
    return {second_of(a.x), second_of(a.y), second_of(a.z)};
}

template <class V>
[[gnu::always_inline]] inline Pairs<V> swapped(const Pairs<V>& a) {
    return {swapped(a.x), swapped(a.y), swapped(a.z)};
}

/// Returns the products number by number.
template <class V>
[[gnu::always_inline]] inline Pairs<V> scaled(const Pairs<V>& a, const Pairs<V>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Returns the largest magnitude of a body's six numbers, in both places of its pair.
template <class V>
[[gnu::always_inline]] inline V largest_of_each(const Pairs<V>& a) {
    using simd::larger, simd::magnitude;
    const V most = larger(larger(magnitude(a.x), magnitude(a.y)), magnitude(a.z));
    return larger(most, swapped(most));
}
[[gnu::always_inline]] inline double largest_of(const ThreePairs& a) {
    return largest_of_each(a)[0];
}

[[gnu::always_inline]] inline DualPlanes to_dual_planes(const Bivector& b) {
    return {Double2{b.xy, b.zw}, Double2{b.xz, -b.yw}, Double2{b.xw, b.yz}};
}
/// Returns a diagonal operator in the order of DualPlanes. Its entries belong to planes without an
/// orientation, so no sign changes.
[[gnu::always_inline]] inline DualPlanes to_dual_planes_unsigned(const Bivector& b) {
    return {Double2{b.xy, b.zw}, Double2{b.xz, b.yw}, Double2{b.xw, b.yz}};
}
[[gnu::always_inline]] inline Bivector to_bivector(const DualPlanes& b) {
    return {b.x[0], b.y[0], b.z[0], b.z[1], -b.y[1], b.x[1]};
}

/// Returns half_commutator() of two bivectors in the order of DualPlanes.
template <class V>
[[gnu::always_inline]] inline Pairs<V> half_commutator(const Pairs<V>& a, const Pairs<V>& b) {
    const Pairs<V> c = swapped(b);
    const auto component = [](V a1, V a2, V b1, V b2, V c1, V c2) {
        return (first_twice(a2) * c1 - first_twice(a1) * c2) +
               (second_twice(a2) * b1 - second_twice(a1) * b2);
    };
    return {component(a.y, a.z, b.y, b.z, c.y, c.z), component(a.z, a.x, b.z, b.x, c.z, c.x),
            component(a.x, a.y, b.x, b.y, c.x, c.y)};
}

/// Takes a bivector (p, q) to the two vectors p - q and -(p + q). Applied to such vectors it
/// returns twice the bivector.
template <class V>
[[gnu::always_inline]] inline Pairs<V> twin_or_planes(const Pairs<V>& a) {
    const auto turned = [](V p) { return second_negated(first_twice(p)) - second_twice(p); };
    return {turned(a.x), turned(a.y), turned(a.z)};
}
template <class V>
[[gnu::always_inline]] inline Pairs<V> to_twin(const Pairs<V>& planes) {
    return twin_or_planes(planes);
}
template <class V>
[[gnu::always_inline]] inline Pairs<V> to_dual_planes(const Pairs<V>& twin) {
    return 0.5 * twin_or_planes(twin);
}

[[gnu::always_inline]] inline TwinQuaternion to_twin(const Rotor& r) {
    return {Double2{r.s + r.p, r.s - r.p}, to_twin(to_dual_planes(r.b))};
}
[[gnu::always_inline]] inline Rotor to_rotor(const TwinQuaternion& q) {
    return {0.5 * (q.s[0] + q.s[1]), to_bivector(to_dual_planes(q.v)), 0.5 * (q.s[0] - q.s[1])};
}

template <class V>
[[gnu::always_inline]] inline V dot(const Pairs<V>& a, const Pairs<V>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class V>
[[gnu::always_inline]] inline Pairs<V> cross(const Pairs<V>& a, const Pairs<V>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Returns q v q~ for unit quaternions q.
template <class V>
[[gnu::always_inline]] inline Pairs<V> rotate(const Twins<V>& q, const Pairs<V>& v) {
    const Pairs<V> twice = 2 * cross(q.v, v);
    return v + (q.s * twice + cross(q.v, twice));
}
/// Returns q~ v q for unit quaternions q, the opposite turn to rotate().
template <class V>
[[gnu::always_inline]] inline Pairs<V> rotate_back(const Twins<V>& q, const Pairs<V>& v) {
    const Pairs<V> twice = 2 * cross(v, q.v);
    return v + (q.s * twice + cross(twice, q.v));
}

template <class V>
[[gnu::always_inline]] inline Twins<V> operator*(const Twins<V>& a, const Twins<V>& b) {
    return {a.s * b.s - dot(a.v, b.v), a.s * b.v + b.s * a.v + cross(a.v, b.v)};
}

/// Returns the planes xy, xz and xw rotated by the unit quaternions q.
[[gnu::always_inline]] inline std::array<DualPlanes, 3> turned_planes(const TwinQuaternion& q) {
    // Half the matrices of both rotations of three dimensions, column by column.
    const TwinVector x = q.v.x * q.v, y = q.v.y * q.v, z = q.v.z * q.v, s = q.s * q.v;
    const Double2 h{0.5, 0.5};
    const TwinVector columns[] = {{h - (y.y + z.z), x.y + s.z, x.z - s.y},
                                  {x.y - s.z, h - (x.x + z.z), y.z + s.x},
                                  {x.z + s.y, y.z - s.x, h - (x.x + y.y)}};
    // Before the turn, the second vector of a plane is the negative of the first.
    const auto plane_of = [](const TwinVector& c) { return twin_or_planes(Double2{1, -1} * c); };
    return {plane_of(columns[0]), plane_of(columns[1]), plane_of(columns[2])};
}

/// Returns the quaternions q, which are not 0, scaled to unit length, as projected_to_spin4() does.
template <class V>
[[gnu::always_inline]] inline Twins<V> normalized(const Twins<V>& q) {
    const V square = q.s * q.s + dot(q.v, q.v), excess = square - 1, off = simd::magnitude(excess);
    // Most are still nearly of unit length: the next term of the series is below 3e-17.
    V k = 1 - excess * (0.5 - excess * (0.375 - excess * 0.3125));
    const auto little = simd::larger(off, swapped(off)) < 1e-4;
    if (!simd::in_all_lanes(little)) k = little ? k : 1 / simd::square_root(square);
    return {k * q.s, k * q.v};
}

}  // namespace tesserae
