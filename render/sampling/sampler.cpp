// SPDX-License-Identifier: Apache-2.0
#include "render/sampling/sampler.hpp"

#include <bit>

namespace tesserae::render {
namespace {

using Signed4 = std::int32_t __attribute__((vector_size(4 * sizeof(std::int32_t))));

// On one index or, for four samples at once, on four: U is std::uint32_t or simd::Unsigned4.

template <class U>
[[gnu::always_inline]] inline U reversed_bits(U v) {
    v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
    v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
    v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
    v = ((v >> 8) & 0x00ff00ffu) | ((v & 0x00ff00ffu) << 8);
    return (v >> 16) | (v << 16);
}

/// A permutation of 32-bit words in which a bit depends on lower bits only: on reversed words, a
/// nested uniform (Owen) scrambling. Constants: Vegdahl, 2021.
template <class U>
[[gnu::always_inline]] inline U scrambled_reversed(U v, U seed) {
    v ^= v * 0x3d20adeau;
    v += seed;
    v *= (seed >> 16) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return v;
}

/// Mixes all bits (splitmix64's finaliser; Steele, Lea and Flood, 2014).
std::uint64_t mixed(std::uint64_t v) {
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9u;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebu;
    return v ^ (v >> 31);
}

/// Sobol's second dimension, bits reversed: its matrix is Pascal's triangle mod 2, which five
/// shifted sums build.
template <class U>
[[gnu::always_inline]] inline U sobol_second_reversed(U v) {
    v ^= (v & 0xaaaaaaaau) >> 1;
    v ^= (v & 0xccccccccu) >> 2;
    v ^= (v & 0xf0f0f0f0u) >> 4;
    v ^= (v & 0xff00ff00u) >> 8;
    v ^= (v & 0xffff0000u) >> 16;
    return v;
}

double to_unit(std::uint32_t reversed) { return reversed_bits(reversed) * 0x1p-32; }
[[gnu::always_inline]] inline simd::Double4 to_unit(simd::Unsigned4 reversed) {
    // As signed numbers, which the CPU converts: half of them lie 1 below.
    const auto half = simd::same_bits<Signed4>(reversed_bits(reversed) ^ 0x80000000u);
    return __builtin_convertvector(half, simd::Double4) * 0x1p-32 + 0.5;
}

/// Generator matrix of a Sobol dimension, columns with their bits reversed: column k is what bit k
/// of the index adds. From the primitive polynomial x^s + a_1 x^(s-1) + ... + 1, its inner
/// coefficients a in one word, and the first s odd numbers m (Joe and Kuo 2008).
template <std::size_t s>
constexpr std::array<std::uint32_t, 32> sobol_columns(std::uint32_t a,
                                                      std::array<std::uint32_t, s> m) {
    std::array<std::uint32_t, 32> v = {};
    for (std::size_t k = 0; k < 32; ++k) {
        if (k < s) {
            v[k] = m[k] << (31 - k);
            continue;
        }
        v[k] = v[k - s] ^ (v[k - s] >> s);
        for (std::size_t j = 1; j < s; ++j)
            if ((a >> (s - 1 - j)) & 1u) v[k] ^= v[k - j];
    }
    std::array<std::uint32_t, 32> reversed = {};
    for (std::size_t k = 0; k < 32; ++k)
        for (int bit = 0; bit < 32; ++bit)
            if ((v[k] >> bit) & 1u) reversed[k] |= 1u << (31 - bit);
    return reversed;
}

/// What each value of each byte of the index adds: four looked up instead of 32 columns.
using SobolBytes = std::array<std::array<std::uint32_t, 256>, 4>;
constexpr SobolBytes sobol_bytes(const std::array<std::uint32_t, 32>& columns) {
    SobolBytes bytes = {};
    for (std::size_t byte = 0; byte < 4; ++byte)
        for (std::size_t value = 1; value < 256; ++value) {
            const auto lowest = static_cast<std::size_t>(std::countr_zero(value));
            bytes[byte][value] = bytes[byte][value & (value - 1)] ^ columns[8 * byte + lowest];
        }
    return bytes;
}
constexpr SobolBytes kSobolThird = sobol_bytes(sobol_columns<2>(1, {1, 3}));
constexpr SobolBytes kSobolFourth = sobol_bytes(sobol_columns<3>(1, {1, 3, 1}));

[[gnu::always_inline]] inline std::uint32_t sobol_reversed(const SobolBytes& bytes,
                                                           std::uint32_t index) {
    return bytes[0][index & 255u] ^ bytes[1][index >> 8 & 255u] ^ bytes[2][index >> 16 & 255u] ^
           bytes[3][index >> 24];
}
[[gnu::always_inline]] inline simd::Unsigned4 sobol_reversed(const SobolBytes& bytes,
                                                             simd::Unsigned4 index) {
    return simd::Unsigned4{sobol_reversed(bytes, index[0]), sobol_reversed(bytes, index[1]),
                           sobol_reversed(bytes, index[2]), sobol_reversed(bytes, index[3])};
}

std::uint64_t pixel_number(int x, int y) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32) |
           static_cast<std::uint32_t>(x);
}

/// 2^64 over the golden ratio: multiples of it differ in all bits.
constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;

}  // namespace

std::uint64_t pixel_hash(int x, int y, std::uint64_t pattern) {
    // Were the pattern added to the pixel's number, those of two frames could be one pattern that
    // is moved over the film.
    const std::uint64_t pixel = mixed(pixel_number(x, y) + kGolden);
    return pattern == 0 ? pixel : mixed(pixel + pattern);
}

std::uint64_t sample_pattern(std::uint64_t seed, int frame) {
    // mixed(0) is 0. Of one seed no two frames have one pattern.
    return mixed(mixed(seed) + kGolden * static_cast<std::uint64_t>(frame));
}

std::uint64_t second_pattern(std::uint64_t pattern) { return mixed(~pattern); }

Vec2 pixel_sample(std::uint64_t seed, std::uint32_t index) {
    return {to_unit(scrambled_reversed(index, static_cast<std::uint32_t>(seed))),
            to_unit(scrambled_reversed(sobol_second_reversed(index),
                                       static_cast<std::uint32_t>(seed >> 32)))};
}

Sampler::Sampler(std::uint64_t pixel_hash, std::uint32_t index)
    : pixel_(mixed(pixel_hash)), index_(index) {}

/// The seeds of a pixel's group: one for each dimension's scrambling and one for the order.
struct Sampler::Seeds {
    std::array<std::uint32_t, 5> of;

    Seeds(std::uint64_t pixel, std::uint32_t group) {
        const std::uint64_t a = mixed(pixel + kGolden * group), b = mixed(a + kGolden),
                            c = mixed(b + kGolden);
        const auto low = [](std::uint64_t v) { return static_cast<std::uint32_t>(v); };
        const auto high = [](std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); };
        of = {low(a), high(a), low(b), high(b), low(c)};
    }
};

namespace {

template <class U>
[[gnu::always_inline]] inline auto numbers_of(U index, const std::array<U, 5>& seeds) {
    const U i = reversed_bits(scrambled_reversed(reversed_bits(index), seeds[4]));
    // The first dimension is the index itself, bits reversed.
    return std::array{to_unit(scrambled_reversed(i, seeds[0])),
                      to_unit(scrambled_reversed(sobol_second_reversed(i), seeds[1])),
                      to_unit(scrambled_reversed(sobol_reversed(kSobolThird, i), seeds[2])),
                      to_unit(scrambled_reversed(sobol_reversed(kSobolFourth, i), seeds[3]))};
}

}  // namespace

std::array<double, 4> Sampler::group(std::uint32_t group) const {
    return numbers_of(index_, Seeds(pixel_, group).of);
}

std::array<simd::Double4, 4> Sampler::groups(const std::array<const Sampler*, 4>& samplers,
                                             std::uint32_t group) {
    std::array<simd::Unsigned4, 5> seeds;
    simd::Unsigned4 index;
    Seeds own(samplers[0]->pixel_, group);
    for (std::size_t i = 0; i < 4; ++i) {
        if (i > 0 && samplers[i]->pixel_ != samplers[i - 1]->pixel_)
            own = Seeds(samplers[i]->pixel_, group);
        for (std::size_t k = 0; k < 5; ++k) seeds[k][i] = own.of[k];
        index[i] = samplers[i]->index_;
    }
    return numbers_of(index, seeds);
}

}  // namespace tesserae::render
