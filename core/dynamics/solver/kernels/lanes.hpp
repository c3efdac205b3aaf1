// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>

#include "core/dynamics/solver/kernels/coloured_islands.hpp"
#include "core/simd/simd.hpp"

// The solver's kernels are templates over F: float, Float8 or Float16. They work on one lane of a
// batch, on all eight, or on the lanes of two batches. The second of two batches lies right behind
// the first and has as many rows. Every operation is rounded as IEEE says, element by element, so
// that all give the same bits.

namespace tesserae::lanes {

using simd::Float4, simd::Float8, simd::Float16;
using simd::fused, simd::larger, simd::magnitude, simd::square_root, simd::largest_lane;

/// The lanes of a batch that are worked on. in_batch(), in_row() and in_responses() are for loads
/// and stores of data that a batch has once, once for each row, and once for each point response.
/// They differ where two batches are worked on: each has its own data.
template <class F>
struct Lane;
template <class F>
struct LaneOfOneBatch {
    static constexpr std::size_t batches = 1;
    template <class T>
    [[gnu::always_inline]] const Lane<F>& in_batch() const {
        return static_cast<const Lane<F>&>(*this);
    }
    template <class T>
    [[gnu::always_inline]] const Lane<F>& in_row() const {
        return static_cast<const Lane<F>&>(*this);
    }
    [[gnu::always_inline]] const Lane<F>& in_responses() const {
        return static_cast<const Lane<F>&>(*this);
    }
};
template <>
struct Lane<Float8> : LaneOfOneBatch<Float8> {
    static constexpr std::size_t first = 0, count = kLanes;
    /// Returns the item of the i-th lane.
    template <class T>
    [[gnu::always_inline]] const T& at(const std::array<T, kLanes>& of, std::size_t i) const {
        return of[i];
    }
    [[gnu::always_inline]] Float8 load(const Eight& from) const {
        Float8 x;
        std::memcpy(&x, from.lane.data(), sizeof x);
        return x;
    }
    [[gnu::always_inline]] void store(Float8 x, Eight& to) const {
        std::memcpy(to.lane.data(), &x, sizeof x);
    }
    [[gnu::always_inline]] Float8 load(const RoughEight& from) const {
        return simd::from_half(simd::same_bits<simd::Half8>(from.lane));
    }
    [[gnu::always_inline]] void store(Float8 x, RoughEight& to) const {
        to = {simd::same_bits<std::array<std::uint16_t, kLanes>>(simd::to_half(x))};
    }
};
template <>
struct Lane<float> : LaneOfOneBatch<float> {
    static constexpr std::size_t count = 1;
    std::size_t first;
    explicit Lane(std::size_t lane) : first(lane) {}
    template <class T>
    [[gnu::always_inline]] const T& at(const std::array<T, kLanes>& of, std::size_t) const {
        return of[first];
    }
    [[gnu::always_inline]] float load(const Eight& from) const { return from.lane[first]; }
    [[gnu::always_inline]] void store(float x, Eight& to) const { to.lane[first] = x; }
    [[gnu::always_inline]] float load(const RoughEight& from) const {
        return simd::from_half(from.lane[first]);
    }
    [[gnu::always_inline]] void store(float x, RoughEight& to) const {
        to.lane[first] = simd::to_half(x);
    }
};

#ifdef __AVX512F__
template <>
class Lane<Float16> {
    static constexpr Lane<Float8> kEight{};

  public:
    static constexpr std::size_t batches = 2, first = 0, count = 2 * kLanes;
    /// @param rows   of either batch
    explicit Lane(std::uint32_t rows) : rows_(rows) {}

    template <class T>
    [[gnu::always_inline]] Lane in_batch() const {
        return {rows_, sizeof(T)};
    }
    template <class T>
    [[gnu::always_inline]] Lane in_row() const {
        return {rows_, rows_ * sizeof(T)};
    }
    [[gnu::always_inline]] Lane in_responses() const {
        return {rows_, responses_of(rows_) * sizeof(RoughEight)};
    }
    template <class T>
    [[gnu::always_inline]] const T& at(const std::array<T, kLanes>& of, std::size_t i) const {
        return i < kLanes ? of[i] : beside(of)[i - kLanes];
    }
    [[gnu::always_inline]] Float16 load(const Eight& from) const {
        return simd::both(kEight.load(from), kEight.load(beside(from)));
    }
    template <class Lanes>
    [[gnu::always_inline]] void store(Float16 x, Lanes& to) const {
        kEight.store(simd::low_half(x), to);
        kEight.store(simd::high_half(x), const_cast<Lanes&>(beside(to)));
    }
    [[gnu::always_inline]] Float16 load(const RoughEight& from) const {
        return simd::from_halves(simd::same_bits<simd::Half8>(from.lane),
                                 simd::same_bits<simd::Half8>(beside(from).lane));
    }

  private:
    Lane(std::uint32_t rows, std::size_t apart) : rows_(rows), apart_(apart) {}
    /// Returns the item of the second batch that corresponds to one of the first.
    template <class T>
    [[gnu::always_inline]] const T& beside(const T& of_first) const {
        return *reinterpret_cast<const T*>(reinterpret_cast<const char*>(&of_first) + apart_);
    }

    std::uint32_t rows_;
    std::size_t apart_ = 0;  ///< [bytes]
};
#endif

// ---- four floats of eight records, transposed ----
[[gnu::always_inline]] inline void load_four(const std::array<const float*, 1>& from,
                                             std::array<float, 4>& to) {
    std::memcpy(&to, from[0], sizeof to);
}
[[gnu::always_inline]] inline void store_four(const std::array<float, 4>& from,
                                              const std::array<float*, 1>& to) {
    std::memcpy(to[0], &from, sizeof from);
}
[[gnu::always_inline]] inline void load_four(const std::array<const float*, kLanes>& from,
                                             std::array<Float8, 4>& to) {
    std::array<Float8, 4> r;  // lane i's four, and those of lane i + 4
    for (std::size_t i = 0; i < 4; ++i) {
        Float4 low, high;
        std::memcpy(&low, from[i], sizeof low);
        std::memcpy(&high, from[i + 4], sizeof high);
        r[i] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    const Float8 a = __builtin_shufflevector(r[0], r[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const Float8 b = __builtin_shufflevector(r[0], r[1], 2, 10, 3, 11, 6, 14, 7, 15);
    const Float8 c = __builtin_shufflevector(r[2], r[3], 0, 8, 1, 9, 4, 12, 5, 13);
    const Float8 d = __builtin_shufflevector(r[2], r[3], 2, 10, 3, 11, 6, 14, 7, 15);
    to[0] = __builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13);
    to[1] = __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15);
    to[2] = __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13);
    to[3] = __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15);
}
[[gnu::always_inline]] inline void store_four(const std::array<Float8, 4>& from,
                                              const std::array<float*, kLanes>& to) {
    const Float8 a = __builtin_shufflevector(from[0], from[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const Float8 b = __builtin_shufflevector(from[0], from[1], 2, 10, 3, 11, 6, 14, 7, 15);
    const Float8 c = __builtin_shufflevector(from[2], from[3], 0, 8, 1, 9, 4, 12, 5, 13);
    const Float8 d = __builtin_shufflevector(from[2], from[3], 2, 10, 3, 11, 6, 14, 7, 15);
    const std::array<Float8, 4> r = {__builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13),
                                     __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15),
                                     __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13),
                                     __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15)};
    for (std::size_t i = 0; i < 4; ++i) {
        const Float4 low = __builtin_shufflevector(r[i], r[i], 0, 1, 2, 3);
        const Float4 high = __builtin_shufflevector(r[i], r[i], 4, 5, 6, 7);
        std::memcpy(to[i], &low, sizeof low);
        std::memcpy(to[i + 4], &high, sizeof high);
    }
}

#ifdef __AVX512F__
/// Transposes each four lanes as a matrix of four by four.
[[gnu::always_inline]] inline std::array<Float16, 4> transposed(const std::array<Float16, 4>& r) {
    const Float16 a = _mm512_unpacklo_ps(r[0], r[1]), b = _mm512_unpackhi_ps(r[0], r[1]);
    const Float16 c = _mm512_unpacklo_ps(r[2], r[3]), d = _mm512_unpackhi_ps(r[2], r[3]);
    return {_mm512_shuffle_ps(a, c, 0x44), _mm512_shuffle_ps(a, c, 0xee),
            _mm512_shuffle_ps(b, d, 0x44), _mm512_shuffle_ps(b, d, 0xee)};
}
[[gnu::always_inline]] inline void load_four(const std::array<const float*, 2 * kLanes>& from,
                                             std::array<Float16, 4>& to) {
    std::array<Float16, 4> r;  // the four of lanes i, i + 4, i + 8, i + 12
    for (std::size_t i = 0; i < 4; ++i) {
        r[i] = _mm512_castps128_ps512(_mm_loadu_ps(from[i]));
        r[i] = _mm512_insertf32x4(r[i], _mm_loadu_ps(from[i + 4]), 1);
        r[i] = _mm512_insertf32x4(r[i], _mm_loadu_ps(from[i + 8]), 2);
        r[i] = _mm512_insertf32x4(r[i], _mm_loadu_ps(from[i + 12]), 3);
    }
    to = transposed(r);
}
[[gnu::always_inline]] inline void store_four(const std::array<Float16, 4>& from,
                                              const std::array<float*, 2 * kLanes>& to) {
    const std::array<Float16, 4> r = transposed(from);
    for (std::size_t i = 0; i < 4; ++i) {
        _mm_storeu_ps(to[i], _mm512_castps512_ps128(r[i]));
        _mm_storeu_ps(to[i + 4], _mm512_extractf32x4_ps(r[i], 1));
        _mm_storeu_ps(to[i + 8], _mm512_extractf32x4_ps(r[i], 2));
        _mm_storeu_ps(to[i + 12], _mm512_extractf32x4_ps(r[i], 3));
    }
}
#endif

// ---- vectors and bivectors of lanes ----
template <class F>
struct LaneVec4 {
    std::array<F, 4> c;
    [[gnu::always_inline]] F& operator[](std::size_t i) { return c[i]; }
    [[gnu::always_inline]] const F& operator[](std::size_t i) const { return c[i]; }
    [[gnu::always_inline]] friend LaneVec4 operator+(const LaneVec4& a, const LaneVec4& b) {
        return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
    }
    [[gnu::always_inline]] friend LaneVec4 operator-(const LaneVec4& a, const LaneVec4& b) {
        return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
    }
    [[gnu::always_inline]] friend LaneVec4 operator*(F k, const LaneVec4& a) {
        return {k * a[0], k * a[1], k * a[2], k * a[3]};
    }
};
template <class F>
[[gnu::always_inline]] inline F dot(const LaneVec4<F>& a, const LaneVec4<F>& b) {
    return fused(a[0], b[0], a[1] * b[1]) + fused(a[2], b[2], a[3] * b[3]);
}
/// Returns a + k b.
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> sum(const LaneVec4<F>& a, F k, const LaneVec4<F>& b) {
    return {fused(k, b[0], a[0]), fused(k, b[1], a[1]), fused(k, b[2], a[2]), fused(k, b[3], a[3])};
}

/// A bivector for each lane. Planes are in the order xy xz xw yz yw zw, as everywhere.
template <class F>
struct LaneBivector {
    std::array<F, 6> c;
    [[gnu::always_inline]] F& operator[](std::size_t i) { return c[i]; }
    [[gnu::always_inline]] const F& operator[](std::size_t i) const { return c[i]; }
    [[gnu::always_inline]] friend LaneBivector operator+(const LaneBivector& a,
                                                         const LaneBivector& b) {
        return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5]};
    }
    [[gnu::always_inline]] friend LaneBivector operator-(const LaneBivector& a,
                                                         const LaneBivector& b) {
        return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3], a[4] - b[4], a[5] - b[5]};
    }
    [[gnu::always_inline]] friend LaneBivector operator*(F k, const LaneBivector& a) {
        return {k * a[0], k * a[1], k * a[2], k * a[3], k * a[4], k * a[5]};
    }
};
template <class F>
[[gnu::always_inline]] inline F dot(const LaneBivector<F>& a, const LaneBivector<F>& b) {
    return fused(a[0], b[0], a[1] * b[1]) + fused(a[2], b[2], a[3] * b[3]) +
           fused(a[4], b[4], a[5] * b[5]);
}
template <class F>
[[gnu::always_inline]] inline LaneBivector<F> wedge(const LaneVec4<F>& a, const LaneVec4<F>& b) {
    const auto plane = [&](std::size_t i, std::size_t j) {
        return fused(a[i], b[j], -(a[j] * b[i]));
    };
    return {plane(0, 1), plane(0, 2), plane(0, 3), plane(1, 2), plane(1, 3), plane(2, 3)};
}
/// Returns tesserae::velocity_at() for each lane.
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> velocity_at(const LaneBivector<F>& w,
                                                      const LaneVec4<F>& r) {
    return {fused(-w[0], r[1], fused(-w[1], r[2], -(w[2] * r[3]))),
            fused(w[0], r[0], fused(-w[3], r[2], -(w[4] * r[3]))),
            fused(w[1], r[0], fused(w[3], r[1], -(w[5] * r[3]))),
            fused(w[2], r[0], fused(w[4], r[1], w[5] * r[2]))};
}

template <class F>
[[gnu::always_inline]] inline LaneVec4<F> load(const Lane<F>& lane,
                                               const std::array<Eight, 4>& from) {
    return {lane.load(from[0]), lane.load(from[1]), lane.load(from[2]), lane.load(from[3])};
}
template <class F, std::size_t kCount>
[[gnu::always_inline]] inline void store(const Lane<F>& lane, const LaneVec4<F>& x,
                                         std::array<Eight, kCount>& to) {
    for (std::size_t i = 0; i < kCount; ++i) lane.store(x[i], to[i]);
}
template <class F>
[[gnu::always_inline]] inline LaneBivector<F> load(const Lane<F>& lane,
                                                   const std::array<Eight, 6>& from) {
    return {lane.load(from[0]), lane.load(from[1]), lane.load(from[2]),
            lane.load(from[3]), lane.load(from[4]), lane.load(from[5])};
}
template <class F>
[[gnu::always_inline]] inline void store(const Lane<F>& lane, const LaneBivector<F>& x,
                                         std::array<Eight, 6>& to) {
    for (std::size_t i = 0; i < 6; ++i) lane.store(x[i], to[i]);
}
/// Loads the first three components of a vector; the last one is 0.
template <class F>
[[gnu::always_inline]] inline LaneVec4<F> load(const Lane<F>& lane,
                                               const std::array<Eight, 3>& from) {
    return {lane.load(from[0]), lane.load(from[1]), lane.load(from[2]), F{}};
}

}  // namespace tesserae::lanes
