#include "render/sampler.hpp"

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

}  // namespace

Vec2 pixel_sample(int x, int y, std::uint32_t index) {
    const std::uint64_t pixel = (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32) |
                                static_cast<std::uint32_t>(x);
    const std::uint64_t seed = mixed(pixel + 0x9e3779b97f4a7c15u);
    return {to_unit(scrambled_reversed(index, static_cast<std::uint32_t>(seed))),
            to_unit(scrambled_reversed(sobol_second_reversed(index),
                                       static_cast<std::uint32_t>(seed >> 32)))};
}

}  // namespace tesserae::render
