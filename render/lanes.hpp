#pragma once

#include <cstdint>
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
inline Lanes larger(Lanes a, Lanes b) { return a > b ? a : b; }
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
