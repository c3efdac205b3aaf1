#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

// Eight floats at once, by the vector extension of gcc and clang: one instruction where the CPU has
// AVX, several elsewhere. For bounds, which are rounded outward: nothing here decides a pixel.
namespace tesserae::render {

constexpr int kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

inline Lanes all_lanes(float v) { return Lanes{v, v, v, v, v, v, v, v}; }

/// The larger of both; b where a is no number.
inline Lanes larger(Lanes a, Lanes b) {
#ifdef __AVX__
    return _mm256_max_ps(a, b);
#else
    return a > b ? a : b;
#endif
}
/// The smaller of both; b where a is no number.
inline Lanes smaller(Lanes a, Lanes b) { return a < b ? a : b; }
inline Lanes magnitude(Lanes v) { return larger(v, -v); }

/// a * b + c, where the CPU can with one rounding.
inline Lanes product_sum(Lanes a, Lanes b, Lanes c) {
#ifdef __FMA__
    return _mm256_fmadd_ps(a, b, c);
#else
    return a * b + c;
#endif
}

inline Lanes square_root(Lanes v) {
#ifdef __AVX__
    return _mm256_sqrt_ps(v);
#else
    for (int i = 0; i < kLanes; ++i) v[i] = __builtin_sqrtf(v[i]);
    return v;
#endif
}

/// The numbers of the lanes whose bits are set, ascending, then zeros; by the bits.
constexpr auto kLanesSet = [] {
    std::array<std::array<std::uint8_t, kLanes>, 1 << kLanes> table{};
    for (std::size_t bits = 0; bits < table.size(); ++bits)
        for (std::uint8_t lane = 0, count = 0; lane < kLanes; ++lane)
            if (bits >> lane & 1) table[bits][count++] = lane;
    return table;
}();

/// Writes the lanes of v whose bits are set to `to`, one after the other, and anything after them:
/// there must be room for all. Without a branch.
inline void store_set(const void* v, std::uint32_t bits, void* to) {
    const std::uint8_t* lanes = kLanesSet[bits].data();
#ifdef __AVX2__
    const __m256i at =
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(lanes)));
    const __m256i all = _mm256_loadu_si256(static_cast<const __m256i*>(v));
    _mm256_storeu_si256(static_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(all, at));
#else
    std::uint32_t from[kLanes], set[kLanes];
    std::memcpy(from, v, sizeof from);
    for (int i = 0; i < kLanes; ++i) set[i] = from[lanes[i]];
    std::memcpy(to, set, sizeof set);
#endif
}

/// Bit i is set where a[i] <= b[i].
inline std::uint32_t not_above(Lanes a, Lanes b) {
#ifdef __AVX__
    return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
#else
    std::uint32_t bits = 0;
    for (int i = 0; i < kLanes; ++i) bits |= static_cast<std::uint32_t>(a[i] <= b[i]) << i;
    return bits;
#endif
}

}  // namespace tesserae::render
