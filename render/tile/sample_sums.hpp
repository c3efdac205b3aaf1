// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/description.hpp"
#include "render/mattes.hpp"
#include "render/scene/ghosts.hpp"
#include "render/tile/pixel_estimate.hpp"

namespace tesserae::render {

/// Sums over a pixel's samples, or over one of their halves.
struct Filtered {
    PixelEstimate color;
    Color albedo = Color::Zero();
    double alpha = 0;
    int count = 0;
    Color direct = Color::Zero(), indirect = Color::Zero();  ///< where they are asked for
    MatteSums* mattes = nullptr;                             ///< the same
    GhostLight ghost;
};

/// What is averaged over a pixel's samples.
struct Averages {
    Color color, variance, albedo;
    double alpha;
    int count;
    Color direct, indirect;
    GhostLight ghost;
};

inline Averages averages_of(const Filtered& sum) {
    return {sum.color.mean(),
            sum.color.variance(),
            sum.albedo / sum.count,
            sum.alpha / sum.count,
            sum.count,
            sum.direct / sum.count,
            sum.indirect / sum.count,
            {sum.ghost.color / sum.count, sum.ghost.alpha / sum.count}};
}

/// Of two independent sets of samples, each with the same weight whatever its number.
inline Averages middle_of(const Averages& a, const Averages& b) {
    return {0.5 * (a.color + b.color),
            0.25 * (a.variance + b.variance),
            0.5 * (a.albedo + b.albedo),
            0.5 * (a.alpha + b.alpha),
            a.count + b.count,
            0.5 * (a.direct + b.direct),
            0.5 * (a.indirect + b.indirect),
            {0.5 * (a.ghost.color + b.ghost.color), 0.5 * (a.ghost.alpha + b.ghost.alpha)}};
}

}  // namespace tesserae::render
