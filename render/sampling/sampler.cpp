#include "render/sampling/sampler.hpp"

namespace tesserae::render {
namespace {

std::uint32_t reversed_bits(std::uint32_t v) {
    v = ((v >> 1) & 0x55555555u) | ((v & 0x55555555u) << 1);
    v = ((v >> 2) & 0x33333333u) | ((v & 0x33333333u) << 2);
    v = ((v >> 4) & 0x0f0f0f0fu) | ((v & 0x0f0f0f0fu) << 4);
    return __builtin_bswap32(v);
}

/// A permutation of 32-bit words in which a bit depends on lower bits only: on reversed words, a
/// nested uniform (Owen) scrambling. Constants: Vegdahl, 2021.
std::uint32_t scrambled_reversed(std::uint32_t v, std::uint32_t seed) {
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
std::uint32_t sobol_second_reversed(std::uint32_t index) {
    std::uint32_t v = index;
    v ^= (v & 0xaaaaaaaau) >> 1;
    v ^= (v & 0xccccccccu) >> 2;
    v ^= (v & 0xf0f0f0f0u) >> 4;
    v ^= (v & 0xff00ff00u) >> 8;
    v ^= (v & 0xffff0000u) >> 16;
    return v;
}

double to_unit(std::uint32_t reversed) { return reversed_bits(reversed) * 0x1p-32; }

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
constexpr auto kSobolThird = sobol_columns<2>(1, {1, 3});
constexpr auto kSobolFourth = sobol_columns<3>(1, {1, 3, 1});

std::uint32_t sobol_reversed(const std::array<std::uint32_t, 32>& columns, std::uint32_t index) {
    std::uint32_t v = 0;
    for (std::size_t k = 0; k < 32; ++k) v ^= (0u - ((index >> k) & 1u)) & columns[k];
    return v;
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

std::array<double, 4> Sampler::group(std::uint32_t group) const {
    const std::uint64_t a = mixed(pixel_ + kGolden * group), b = mixed(a + kGolden),
                        c = mixed(b + kGolden);
    const auto low = [](std::uint64_t v) { return static_cast<std::uint32_t>(v); };
    const auto high = [](std::uint64_t v) { return static_cast<std::uint32_t>(v >> 32); };
    const std::uint32_t i = reversed_bits(scrambled_reversed(reversed_bits(index_), low(c)));
    // The first dimension is the index itself, bits reversed.
    return {to_unit(scrambled_reversed(i, low(a))),
            to_unit(scrambled_reversed(sobol_second_reversed(i), high(a))),
            to_unit(scrambled_reversed(sobol_reversed(kSobolThird, i), low(b))),
            to_unit(scrambled_reversed(sobol_reversed(kSobolFourth, i), high(b)))};
}

}  // namespace tesserae::render
