// SPDX-License-Identifier: Apache-2.0
#include "render/tint.hpp"

#include <algorithm>
#include <cmath>

#include "render/sampling/sampler.hpp"

namespace tesserae::render {

Color tint_of(BodyId body, double variation) {
    constexpr std::uint64_t kTints = 0x74696e74;  // a pattern of random numbers that no picture has
    const std::uint64_t bits = pixel_hash(static_cast<int>(body), 0, kTints);
    const auto random = [&](int i) {
        return static_cast<double>(bits >> (16 * i) & 0xffff) / 0x10000;
    };
    const Color own(random(1), random(2), random(3));
    return 1 - variation * (0.75 * random(0) + 0.25 * own);
}

Color turned_hue(const Color& color, double turn) {
    const double most = color.maxCoeff(), least = color.minCoeff(), range = most - least;
    if (!(range > 0)) return color;
    // Sixths of the circle from red.
    double hue;
    if (most == color[0])
        hue = (color[1] - color[2]) / range;
    else if (most == color[1])
        hue = 2 + (color[2] - color[0]) / range;
    else
        hue = 4 + (color[0] - color[1]) / range;
    hue += 6 * turn;
    Color turned;
    for (int i = 0; i < 3; ++i) {
        const double at = hue - 2 * i, away = std::abs(at - 6 * std::round(at / 6));
        turned[i] = least + range * std::clamp(2 - away, 0.0, 1.0);
    }
    return turned;
}

double hue_turn_of(BodyId body, double jitter) {
    constexpr std::uint64_t kHues = 0x68756573;  // as kTints
    const std::uint64_t bits = pixel_hash(static_cast<int>(body), 0, kHues);
    return jitter * (static_cast<double>(bits >> 11) * 0x1p-53 - 0.5);
}

}  // namespace tesserae::render
