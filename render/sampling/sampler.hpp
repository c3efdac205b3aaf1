// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/simd/simd.hpp"
#include "render/camera/camera.hpp"

namespace tesserae::render {

/// A number that tells apart the patterns of random numbers of all seeds and frames: those of
/// different ones are independent, and equally well distributed. Pattern 0 is that of frame 0 with
/// seed 0.
std::uint64_t sample_pattern(std::uint64_t seed, int frame);

/// The pattern of a second, independent set of samples beside those of `pattern`.
std::uint64_t second_pattern(std::uint64_t pattern);

/// A hash of a pixel and the pattern of its samples, from which all their numbers are made.
std::uint64_t pixel_hash(int x, int y, std::uint64_t pattern);

/// Where sample `index` of pixel (x, y) lies inside the pixel: a point of [0, 1)^2. A function of
/// its arguments alone, pixels counted from the full frame's corner, so that crop, tile size and
/// threads change nothing.
/// The points of a pixel are the first two Sobol dimensions, each pixel with its own Owen
/// scrambling: every 2^k x 2^(m-k) grid of equal cells holds one point of 2^m.
/// Source: Burley, Practical Hash-based Owen Scrambling, JCGT 9(4), 2020, listings 1 to 3; the hash
/// constants are those of its corrected listing (Vegdahl 2021).
Vec2 pixel_sample(std::uint64_t pixel_hash, std::uint32_t index);
inline Vec2 pixel_sample(int x, int y, std::uint32_t index, std::uint64_t pattern = 0) {
    return pixel_sample(pixel_hash(x, y, pattern), index);
}

/// The numbers of [0, 1) that one sample of a pixel needs beyond its place in the pixel, in groups
/// of four. Group g of sample i is point i of a four-dimensional Sobol sequence, whose order is
/// shuffled and whose dimensions are Owen-scrambled, both by (pixel, g): within a group the points
/// of a pixel are stratified (2^m of them: one in each of 2^m equal intervals of every dimension,
/// one in each cell of every grid of 2^m over the first two), between groups and pixels they are
/// independent. A function of (x, y, index, pattern, group) alone.
/// Source: Burley 2020, section 4 (shuffled nested uniform scrambling, padded); direction numbers:
/// Joe and Kuo 2008, dimensions 1 to 4.
class Sampler {
  public:
    Sampler(std::uint64_t pixel_hash, std::uint32_t index);
    Sampler(int x, int y, std::uint32_t index, std::uint64_t pattern = 0)
        : Sampler(render::pixel_hash(x, y, pattern), index) {}

    std::uint32_t index() const { return index_; }
    /// That of another sample of the same pixel.
    Sampler of(std::uint32_t index) const {
        Sampler other = *this;
        other.index_ = index;
        return other;
    }
    std::array<double, 4> group(std::uint32_t group) const;
    /// The same of four samples at once, number by number: [k][i] is samplers[i]->group(group)[k].
    static std::array<simd::Double4, 4> groups(const std::array<const Sampler*, 4>& samplers,
                                               std::uint32_t group);

  private:
    struct Seeds;

    std::uint64_t pixel_;  ///< a hash of pixel and pattern
    std::uint32_t index_;
};

}  // namespace tesserae::render
