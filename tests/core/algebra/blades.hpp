// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <random>

#include "core/algebra/rotor.hpp"

// An independent algebra for the tests: all 16 blades of 4D space, addressed by bit mask (x = 1,
// y = 2, z = 4, w = 8), multiplied by counting swaps.
namespace tesserae {

using Multivector = std::array<double, 16>;

/// The sign that sorting the axes of blade a followed by blade b gives.
inline int product_sign(unsigned a, unsigned b) {
    int swaps = 0;
    for (unsigned rest = a >> 1; rest; rest >>= 1) swaps += __builtin_popcount(rest & b);
    return swaps % 2 ? -1 : 1;
}

inline Multivector product(const Multivector& a, const Multivector& b) {
    Multivector c{};
    for (unsigned i = 0; i < 16; ++i)
        for (unsigned j = 0; j < 16; ++j) c[i ^ j] += product_sign(i, j) * a[i] * b[j];
    return c;
}

inline Multivector to_blades(const Rotor& r) {
    Multivector m{};
    m[0] = r.s, m[3] = r.b.xy, m[5] = r.b.xz, m[9] = r.b.xw;
    m[6] = r.b.yz, m[10] = r.b.yw, m[12] = r.b.zw, m[15] = r.p;
    return m;
}
inline Multivector to_blades(const Vec4& v) {
    Multivector m{};
    m[1] = v[0], m[2] = v[1], m[4] = v[2], m[8] = v[3];
    return m;
}
inline Vec4 vector_part(const Multivector& m) { return {m[1], m[2], m[4], m[8]}; }

inline double largest_difference(const Multivector& a, const Multivector& b) {
    double largest = 0;
    for (unsigned i = 0; i < 16; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}
inline double largest_difference(const Rotor& a, const Rotor& b) {
    return largest_difference(to_blades(a), to_blades(b));
}
inline double largest_difference(const Bivector& a, const Bivector& b) {
    return largest_difference(Rotor{0, a, 0}, Rotor{0, b, 0});
}

struct RandomAlgebra {
    std::mt19937_64 engine;
    explicit RandomAlgebra(std::uint64_t seed) : engine(seed) {}

    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    double gauss() { return std::normal_distribution<double>()(engine); }
    Vec4 vector() { return {gauss(), gauss(), gauss(), gauss()}; }
    Bivector bivector() { return {gauss(), gauss(), gauss(), gauss(), gauss(), gauss()}; }
    /// A plane: unit and simple.
    Bivector plane() {
        const Bivector b = wedge(vector(), vector());
        return (1 / norm(b)) * b;
    }
    /// Eight free numbers, no rotor.
    Rotor even() { return {gauss(), bivector(), gauss()}; }
    /// A unit rotor from the product of four random unit vectors: needs no exp, no projection.
    Rotor rotor() {
        Multivector m{1};
        for (int i = 0; i < 4; ++i) m = product(m, to_blades(Vec4(vector().normalized())));
        return {m[0], {m[3], m[5], m[9], m[6], m[10], m[12]}, m[15]};
    }
};

/// How far the two conditions of Spin(4) are missed.
inline double spin4_defect(const Rotor& r) {
    return std::max(std::abs(r.s * r.s + dot(r.b, r.b) + r.p * r.p - 1),
                    std::abs(2 * r.s * r.p - wedge(r.b, r.b)));
}

}  // namespace tesserae
