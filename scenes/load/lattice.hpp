// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/algebra/vector.hpp"

namespace tesserae::scenes {

/// A regular grid of bodies.
struct Lattice {
    std::array<std::uint32_t, 4> count = {1, 1, 1, 1};  ///< each >= 1
    Vec4 spacing = Vec4::Zero();                        ///< between neighbours [m], >= 0
    double jitter = 0;                                  ///< [m], >= 0
    std::uint64_t seed = 1;
};

/// Uniform in [0, 1), 53 bits, a pure function of its arguments: the splitmix64 output function
/// (Steele, Lea, Flood 2014) of the seed, then of that plus the number 4 index + axis of the draw.
double lattice_random(std::uint64_t seed, std::uint64_t index, int axis);

/// Where the body `index` of a lattice lies, relative to the lattice's centre [m]. x is slowest, w
/// fastest. Each coordinate is moved by a random distance in [-jitter, jitter).
Vec4 lattice_point(const Lattice& lattice, std::uint64_t index);

}  // namespace tesserae::scenes
