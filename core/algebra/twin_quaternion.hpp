#pragma once

#include <array>
#include <cmath>

#include "core/algebra/rotor.hpp"
#include "core/simd/simd.hpp"

// Bivectors and rotors as pairs of numbers that the same is done to, so that each operation of a
// CPU does two. A rotor is two quaternions, a bivector their parts without a scalar (rotor.cpp). Of
// the second quaternion the negative of that part is taken here: then both multiply alike.
//
// All is inlined: in memory, the pairs would have to be put together again from single numbers.
namespace tesserae {

using simd::Double2;

/// Six numbers in three pairs.
struct ThreePairs {
    Double2 x, y, z;

    friend ThreePairs operator+(const ThreePairs& a, const ThreePairs& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend ThreePairs operator-(const ThreePairs& a, const ThreePairs& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend ThreePairs operator-(const ThreePairs& a) { return {-a.x, -a.y, -a.z}; }
    friend ThreePairs operator*(Double2 k, const ThreePairs& a) {
        return {k * a.x, k * a.y, k * a.z};
    }
    friend ThreePairs operator*(double k, const ThreePairs& a) { return Double2{k, k} * a; }
};

/// A bivector, each plane beside the one orthogonal to it: (xy, zw), (xz, wy), (xw, yz).
using DualPlanes = ThreePairs;
/// The vectors of two quaternions, one beside the other.
using TwinVector = ThreePairs;

/// Two quaternions, scalars and vectors, with x y = z in both.
struct TwinQuaternion {
    Double2 s;
    TwinVector v;
};

[[gnu::always_inline]] inline Double2 swapped(Double2 a) {
    return __builtin_shufflevector(a, a, 1, 0);
}
[[gnu::always_inline]] inline Double2 first_twice(Double2 a) {
    return __builtin_shufflevector(a, a, 0, 0);
}
[[gnu::always_inline]] inline Double2 second_twice(Double2 a) {
    return __builtin_shufflevector(a, a, 1, 1);
}

[[gnu::always_inline]] inline ThreePairs swapped(const ThreePairs& a) {
    return {swapped(a.x), swapped(a.y), swapped(a.z)};
}

/// Number by number.
[[gnu::always_inline]] inline ThreePairs scaled(const ThreePairs& a, const ThreePairs& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// The larger of the magnitudes of all six numbers.
[[gnu::always_inline]] inline double largest_of(const ThreePairs& a) {
    using simd::larger, simd::magnitude;
    const Double2 most = larger(larger(magnitude(a.x), magnitude(a.y)), magnitude(a.z));
    return larger(most[0], most[1]);
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
[[gnu::always_inline]] inline DualPlanes half_commutator(const DualPlanes& a, const DualPlanes& b) {
    const DualPlanes c = swapped(b);
    const auto component = [](Double2 a1, Double2 a2, Double2 b1, Double2 b2, Double2 c1,
                              Double2 c2) {
        return (first_twice(a2) * c1 - first_twice(a1) * c2) +
               (second_twice(a2) * b1 - second_twice(a1) * b2);
    };
    return {component(a.y, a.z, b.y, b.z, c.y, c.z), component(a.z, a.x, b.z, b.x, c.z, c.x),
            component(a.x, a.y, b.x, b.y, c.x, c.y)};
}

/// A bivector (p, q) as the two vectors p - q and -(p + q), and such vectors as twice the bivector.
[[gnu::always_inline]] inline ThreePairs twin_or_planes(const ThreePairs& a) {
    const auto turned = [](Double2 p) { return first_twice(p) * Double2{1, -1} - second_twice(p); };
    return {turned(a.x), turned(a.y), turned(a.z)};
}
[[gnu::always_inline]] inline TwinVector to_twin(const DualPlanes& b) { return twin_or_planes(b); }
[[gnu::always_inline]] inline DualPlanes to_dual_planes(const TwinVector& v) {
    return 0.5 * twin_or_planes(v);
}

[[gnu::always_inline]] inline TwinQuaternion to_twin(const Rotor& r) {
    return {Double2{r.s + r.p, r.s - r.p}, to_twin(to_dual_planes(r.b))};
}
[[gnu::always_inline]] inline Rotor to_rotor(const TwinQuaternion& q) {
    return {0.5 * (q.s[0] + q.s[1]), to_bivector(to_dual_planes(q.v)), 0.5 * (q.s[0] - q.s[1])};
}

[[gnu::always_inline]] inline Double2 dot(const TwinVector& a, const TwinVector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline TwinVector cross(const TwinVector& a, const TwinVector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// q v q~ of unit quaternions.
[[gnu::always_inline]] inline TwinVector rotate(const TwinQuaternion& q, const TwinVector& v) {
    const TwinVector twice = 2 * cross(q.v, v);
    return v + (q.s * twice + cross(q.v, twice));
}
/// q~ v q of unit quaternions.
[[gnu::always_inline]] inline TwinVector rotate_back(const TwinQuaternion& q, const TwinVector& v) {
    const TwinVector twice = 2 * cross(v, q.v);
    return v + (q.s * twice + cross(twice, q.v));
}

[[gnu::always_inline]] inline TwinQuaternion operator*(const TwinQuaternion& a,
                                                       const TwinQuaternion& b) {
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
[[gnu::always_inline]] inline TwinQuaternion normalized(const TwinQuaternion& q) {
    const Double2 square = q.s * q.s + dot(q.v, q.v), excess = square - 1;
    // Most have turned little since they were of unit length: the series' next term is below 3e-17.
    Double2 k = 1 - excess * (0.5 - excess * (0.375 - excess * 0.3125));
    if (!(simd::largest_lane(simd::magnitude(excess)) < 1e-4))
        k = 1 / Double2{std::sqrt(square[0]), std::sqrt(square[1])};
    return {k * q.s, k * q.v};
}

}  // namespace tesserae
