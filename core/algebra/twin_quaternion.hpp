#pragma once

#include <array>
#include <cmath>

#include "core/algebra/rotor.hpp"
#include "core/simd/simd.hpp"

// Bivectors and rotors as pairs of numbers that the same is done to, so that each operation of a
// CPU does two, or those of two bodies, four. A rotor is two quaternions, a bivector their parts
// without a scalar (rotor.cpp). Of the second quaternion the negative of that part is taken here:
// then both multiply alike.
//
// All is inlined: in memory, the pairs would have to be put together again from single numbers.
namespace tesserae {

using simd::Double2, simd::Double4;

/// Six numbers in three pairs.
/// @tparam V   Double2, or Double4: two pairs
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

/// A bivector, each plane beside the one orthogonal to it: (xy, zw), (xz, wy), (xw, yz).
using DualPlanes = ThreePairs;
/// The vectors of two quaternions, one beside the other.
using TwinVector = ThreePairs;

/// Two quaternions, scalars and vectors, with x y = z in both.
template <class V>
struct Twins {
    V s;
    Pairs<V> v;
};
using TwinQuaternion = Twins<Double2>;

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
/// In each pair the second number with the other sign.
[[gnu::always_inline]] inline Double2 second_negated(Double2 a) { return a * Double2{1, -1}; }
[[gnu::always_inline]] inline Double4 second_negated(Double4 a) {
    return a * Double4{1, -1, 1, -1};
}

/// Two pairs, and each of them again.
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

/// Number by number.
template <class V>
[[gnu::always_inline]] inline Pairs<V> scaled(const Pairs<V>& a, const Pairs<V>& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// In both numbers of a pair the larger of the magnitudes of all its six.
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
/// Of a diagonal operator, whose entries are of planes without an orientation.
[[gnu::always_inline]] inline DualPlanes to_dual_planes_unsigned(const Bivector& b) {
    return {Double2{b.xy, b.zw}, Double2{b.xz, b.yw}, Double2{b.xw, b.yz}};
}
[[gnu::always_inline]] inline Bivector to_bivector(const DualPlanes& b) {
    return {b.x[0], b.y[0], b.z[0], b.z[1], -b.y[1], b.x[1]};
}

/// half_commutator() of bivectors.
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

/// A bivector (p, q) as the two vectors p - q and -(p + q), and such vectors as twice the bivector.
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

/// q v q~ of unit quaternions.
template <class V>
[[gnu::always_inline]] inline Pairs<V> rotate(const Twins<V>& q, const Pairs<V>& v) {
    const Pairs<V> twice = 2 * cross(q.v, v);
    return v + (q.s * twice + cross(q.v, twice));
}
/// q~ v q of unit quaternions.
template <class V>
[[gnu::always_inline]] inline Pairs<V> rotate_back(const Twins<V>& q, const Pairs<V>& v) {
    const Pairs<V> twice = 2 * cross(v, q.v);
    return v + (q.s * twice + cross(twice, q.v));
}

template <class V>
[[gnu::always_inline]] inline Twins<V> operator*(const Twins<V>& a, const Twins<V>& b) {
    return {a.s * b.s - dot(a.v, b.v), a.s * b.v + b.s * a.v + cross(a.v, b.v)};
}

/// What unit quaternions turn the planes xy, xz and xw to.
[[gnu::always_inline]] inline std::array<DualPlanes, 3> turned_planes(const TwinQuaternion& q) {
    // Half the matrices of both rotations of three dimensions, column by column.
    const TwinVector x = q.v.x * q.v, y = q.v.y * q.v, z = q.v.z * q.v, s = q.s * q.v;
    const Double2 h{0.5, 0.5};
    const TwinVector columns[] = {{h - (y.y + z.z), x.y + s.z, x.z - s.y},
                                  {x.y - s.z, h - (x.x + z.z), y.z + s.x},
                                  {x.z + s.y, y.z - s.x, h - (x.x + y.y)}};
    // Of a plane the second vector is the negative of the first, before they are turned.
    const auto plane_of = [](const TwinVector& c) { return twin_or_planes(Double2{1, -1} * c); };
    return {plane_of(columns[0]), plane_of(columns[1]), plane_of(columns[2])};
}

/// Unit quaternions from ones that are not 0, as projected_to_spin4() does.
template <class V>
[[gnu::always_inline]] inline Twins<V> normalized(const Twins<V>& q) {
    const V square = q.s * q.s + dot(q.v, q.v), excess = square - 1, off = simd::magnitude(excess);
    // Most have turned little since they were of unit length: the series' next term is below 3e-17.
    V k = 1 - excess * (0.5 - excess * (0.375 - excess * 0.3125));
    const auto little = simd::larger(off, swapped(off)) < 1e-4;
    if (!simd::in_all_lanes(little)) k = little ? k : 1 / simd::square_root(square);
    return {k * q.s, k * q.v};
}

}  // namespace tesserae
