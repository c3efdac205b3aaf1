// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "render/tile/pixel_estimate.hpp"

namespace tesserae::render {

/// Which part of a pixel's samples half 0 or 1 takes; at least one.
inline int half_of(int samples, std::size_t half) {
    return std::max(1, (samples + (half == 0 ? 1 : 0)) / 2);
}

/// Takes more samples of a pixel where it is noisy, without a bias.
///
/// Where the samples that are averaged also decide how many they are, their mean is wrong: a pixel
/// that happens not to have met the light looks converged and stays dark. So the samples are two
/// halves, independent of each other. Each begins with half of `least`, and the noise of these
/// decides how many the other half gets. The pixel is the mean of both halves' means, with the same
/// weight whatever their numbers: no half's number depends on its own samples, so each mean, and
/// with it the pixel, has the expectation that any fixed number of samples has.
///
/// What a light that no sample has met would add is known to nobody: there a pixel keeps its
/// `least` samples and their noise, which is as often too bright as its darkness asks for.
/// @param least, most   samples of the pixel; 2 at least
/// @param target        see PixelEstimate::samples_for(); > 0
/// @param draw          draw(half, count) adds samples to half 0 or 1 until it has so many, and
///                      returns the half's PixelEstimate
template <class Draw>
void sample_adaptively(int least, int most, double target, const Draw& draw) {
    std::array<double, 2> wanted;  // of the pixel
    for (std::size_t half = 0; half < 2; ++half)
        wanted[1 - half] = draw(half, half_of(least, half)).samples_for(target);
    for (std::size_t half = 0; half < 2; ++half) {
        const int bound = half_of(most, half);
        const double count = std::ceil(0.5 * wanted[half]);
        draw(half, count < bound ? static_cast<int>(count) : bound);
    }
}

}  // namespace tesserae::render
