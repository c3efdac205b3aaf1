// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#ifdef __AVX__
#include <immintrin.h>
#endif

// This header works on several numbers at once, by the vector extension of gcc and clang. An
// operation is one instruction if the CPU has AVX, otherwise several. Every operation is rounded as
// IEEE says, element by element, so that a lane has the bits of a plain number. Only product_sum()
// is an exception.
//
// All functions are inlined: in a loop a call would put the vectors into memory.
namespace tesserae::simd {

/// A Float8 has so many lanes.
constexpr std::size_t kLanes = 8;

using Float4 = float __attribute__((vector_size(4 * sizeof(float))));
using Float8 = float __attribute__((vector_size(kLanes * sizeof(float))));
/// A Float16 is two Float8. It is used if the CPU has AVX-512.
using Float16 = float __attribute__((vector_size(2 * kLanes * sizeof(float))));
using Unsigned4 = std::uint32_t __attribute__((vector_size(4 * sizeof(std::uint32_t))));
using Half8 = std::uint16_t __attribute__((vector_size(kLanes * sizeof(std::uint16_t))));
using Unsigned8 = std::uint32_t __attribute__((vector_size(kLanes * sizeof(std::uint32_t))));
using Double2 = double __attribute__((vector_size(2 * sizeof(double))));
using Double4 = double __attribute__((vector_size(4 * sizeof(double))));
/// A Mask4 is the result of a comparison of two Double4.
using Mask4 = long long __attribute__((vector_size(4 * sizeof(long long))));

/// Returns a vector with the same number in all lanes.
[[gnu::always_inline]] inline Float8 all_lanes(float x) { return Float8{x, x, x, x, x, x, x, x}; }
[[gnu::always_inline]] inline Double4 all_four(double x) { return Double4{x, x, x, x}; }

/// Converts numbers to another type of the same size and keeps their bits.
template <class To, class From>
[[gnu::always_inline]] inline To same_bits(From from) {
    static_assert(sizeof(To) == sizeof(From));
    To to;
    std::memcpy(&to, &from, sizeof to);
    return to;
}

/// Returns the larger of both; b if they are equal or one is NaN.
template <class V>
[[gnu::always_inline]] inline V larger(V a, V b) {
    return a > b ? a : b;
}
/// Returns the smaller of both; b if they are equal or one is NaN.
template <class V>
[[gnu::always_inline]] inline V smaller(V a, V b) {
    return a < b ? a : b;
}
#ifdef __AVX__
template <>
[[gnu::always_inline]] inline Float8 larger(Float8 a, Float8 b) {
    return _mm256_max_ps(a, b);
}
#endif
template <class V>
[[gnu::always_inline]] inline V magnitude(V a) {
    return larger(a, -a);
}

[[gnu::always_inline]] inline float square_root(float x) { return std::sqrt(x); }
[[gnu::always_inline]] inline Float8 square_root(Float8 x) {
#ifdef __AVX__
    return _mm256_sqrt_ps(x);
#else
    for (std::size_t i = 0; i < kLanes; ++i) x[i] = std::sqrt(x[i]);
    return x;
#endif
}

[[gnu::always_inline]] inline double square_root(double x) { return std::sqrt(x); }
[[gnu::always_inline]] inline Double2 square_root(Double2 x) {
    return Double2{std::sqrt(x[0]), std::sqrt(x[1])};
}
[[gnu::always_inline]] inline Double4 square_root(Double4 x) {
#ifdef __AVX__
    return _mm256_sqrt_pd(x);
#else
    for (std::size_t i = 0; i < 4; ++i) x[i] = std::sqrt(x[i]);
    return x;
#endif
}

/// Returns a * b + c, with one rounding if the CPU can. It serves for bounds that are rounded
/// outward.
[[gnu::always_inline]] inline Float8 product_sum(Float8 a, Float8 b, Float8 c) {
#ifdef __FMA__
    return _mm256_fmadd_ps(a, b, c);
#else
    return a * b + c;
#endif
}

/// Returns a * b + c with one rounding, the same bits on every CPU. It is slow on a CPU that has no
/// instruction for it.
[[gnu::always_inline]] inline float fused(float a, float b, float c) {
#ifdef __FMA__
    return __builtin_fmaf(a, b, c);
#else
    return std::fma(a, b, c);
#endif
}
[[gnu::always_inline]] inline Float8 fused(Float8 a, Float8 b, Float8 c) {
#ifdef __FMA__
    return _mm256_fmadd_ps(a, b, c);
#else
    for (std::size_t i = 0; i < kLanes; ++i) c[i] = std::fma(a[i], b[i], c[i]);
    return c;
#endif
}

/// Rounds a finite float below 2^127 to eight significant bits, half to even, and returns its upper
/// half (bfloat16). from_half() converts back.
[[gnu::always_inline]] inline std::uint16_t to_half(float x) {
    const auto bits = same_bits<std::uint32_t>(x);
    return static_cast<std::uint16_t>((bits + 0x7fff + ((bits >> 16) & 1)) >> 16);
}
[[gnu::always_inline]] inline Half8 to_half(Float8 x) {
    using Half16 = std::uint16_t __attribute__((vector_size(2 * sizeof(Half8))));
    const auto bits = same_bits<Unsigned8>(x);
    const auto halves = same_bits<Half16>(bits + 0x7fff + ((bits >> 16) & 1));
    return __builtin_shufflevector(halves, halves, 1, 3, 5, 7, 9, 11, 13, 15);
}
[[gnu::always_inline]] inline float from_half(std::uint16_t x) {
    return same_bits<float>(std::uint32_t{x} << 16);
}
[[gnu::always_inline]] inline Float8 from_half(Half8 x) {
#ifdef __AVX2__
    return same_bits<Float8>(_mm256_slli_epi32(_mm256_cvtepu16_epi32(same_bits<__m128i>(x)), 16));
#else
    return same_bits<Float8>(__builtin_convertvector(x, Unsigned8) << 16);
#endif
}

// ---- from lanes to one number ----
[[gnu::always_inline]] inline float largest_lane(float x) { return x; }
[[gnu::always_inline]] inline float largest_lane(Float8 x) {
    float largest = x[0];
    for (std::size_t i = 1; i < kLanes; ++i) largest = larger(largest, x[i]);
    return largest;
}
[[gnu::always_inline]] inline double largest_lane(Double2 v) { return v[0] < v[1] ? v[1] : v[0]; }
[[gnu::always_inline]] inline double largest_lane(Double4 v) {
    v = larger(v, __builtin_shufflevector(v, v, 2, 3, 0, 1));
    return v[0] < v[1] ? v[1] : v[0];
}
[[gnu::always_inline]] inline double smallest_lane(Double4 v) {
    v = smaller(v, __builtin_shufflevector(v, v, 2, 3, 0, 1));
    return v[1] < v[0] ? v[1] : v[0];
}
[[gnu::always_inline]] inline double sum_of_lanes(Double4 v) {
    v += __builtin_shufflevector(v, v, 2, 3, 0, 1);
    return v[0] + v[1];
}

// ---- sets of lanes, as bits ----
/// Returns a set of bits: bit i is set where the lane v[i] is set.
[[gnu::always_inline]] inline int lanes_set(Mask4 v) {
#ifdef __AVX__
    return _mm256_movemask_pd(reinterpret_cast<Double4>(v));
#else
    return static_cast<int>((v[0] & 1) | (v[1] & 2) | (v[2] & 4) | (v[3] & 8));
#endif
}
/// Returns whether a comparison of two Double2 or Double4 holds in all lanes.
template <class Mask>
[[gnu::always_inline]] inline bool in_all_lanes(Mask v) {
    if constexpr (sizeof(v) == sizeof(Double2))
        return (v[0] & v[1]) != 0;
    else
        return lanes_set(same_bits<Mask4>(v)) == 15;
}
/// Returns whether a <= b in all lanes.
[[gnu::always_inline]] inline bool nowhere_above(float a, float b) { return a <= b; }
[[gnu::always_inline]] inline bool nowhere_above(Float8 a, Float8 b);

/// Returns a set of bits: bit i is set where a[i] <= b[i].
[[gnu::always_inline]] inline std::uint32_t not_above(Float8 a, Float8 b) {
#ifdef __AVX__
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
#else
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < kLanes; ++i) bits |= static_cast<std::uint32_t>(a[i] <= b[i]) << i;
    return bits;
#endif
}

[[gnu::always_inline]] inline bool nowhere_above(Float8 a, Float8 b) {
    return not_above(a, b) == (1u << kLanes) - 1;
}

/// For each set of bits, this table holds the numbers of the lanes that are set, ascending, then
/// zeros.
inline constexpr auto kLanesSet = [] {
    std::array<std::array<std::uint8_t, kLanes>, 1 << kLanes> table{};
    for (std::size_t bits = 0; bits < table.size(); ++bits)
        for (std::uint8_t lane = 0, count = 0; lane < kLanes; ++lane)
            if (bits >> lane & 1) table[bits][count++] = lane;
    return table;
}();

/// Writes the lanes of v whose bits are set to `to`, one after the other, without a branch.
/// Anything may be written after them: there must be room for all lanes.
/// @param v   eight numbers of four bytes
[[gnu::always_inline]] inline void store_set(const void* v, std::uint32_t bits, void* to) {
    const std::uint8_t* lanes = kLanesSet[bits].data();
#ifdef __AVX2__
    const __m256i at =
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(lanes)));
    const __m256i all = _mm256_loadu_si256(static_cast<const __m256i*>(v));
    _mm256_storeu_si256(static_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(all, at));
#else
    std::uint32_t from[kLanes], set[kLanes];
    std::memcpy(from, v, sizeof from);
    for (std::size_t i = 0; i < kLanes; ++i) set[i] = from[lanes[i]];
    std::memcpy(to, set, sizeof set);
#endif
}

#ifdef __AVX512F__
// ---- sixteen lanes ----
template <>
[[gnu::always_inline]] inline Float16 larger(Float16 a, Float16 b) {
    return _mm512_max_ps(a, b);
}
[[gnu::always_inline]] inline Float16 square_root(Float16 x) { return _mm512_sqrt_ps(x); }
[[gnu::always_inline]] inline Float16 fused(Float16 a, Float16 b, Float16 c) {
    return _mm512_fmadd_ps(a, b, c);
}
[[gnu::always_inline]] inline Float16 both(Float8 low, Float8 high) {
    return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
}
[[gnu::always_inline]] inline Float8 low_half(Float16 x) { return _mm512_castps512_ps256(x); }
[[gnu::always_inline]] inline Float8 high_half(Float16 x) { return _mm512_extractf32x8_ps(x, 1); }
[[gnu::always_inline]] inline Float16 from_halves(Half8 low, Half8 high) {
    const __m256i halves = _mm256_inserti128_si256(_mm256_castsi128_si256(same_bits<__m128i>(low)),
                                                   same_bits<__m128i>(high), 1);
    return same_bits<Float16>(_mm512_slli_epi32(_mm512_cvtepu16_epi32(halves), 16));
}
[[gnu::always_inline]] inline float largest_lane(Float16 x) {
    return largest_lane(larger(low_half(x), high_half(x)));
}
[[gnu::always_inline]] inline bool nowhere_above(Float16 a, Float16 b) {
    return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ) == 0xffff;
}
#endif

}  // namespace tesserae::simd
