// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

namespace tesserae::render {

/// A body's shadow on a light's disc, as seen from a point: a ball in the 3-ball of directions,
/// whose unit is the light's half-angle.
struct DiscCover {
    std::uint32_t body;
    double rim;  ///< from the disc's middle to the nearest rim, in (-1, 1)
    Eigen::Vector3d toward = Eigen::Vector3d::Zero();  ///< unit: where the ball's centre lies
    double radius = 0;                                 ///< of the ball; > 0
};

/// The part of a light's disc that lies beyond a flat rim at angle x * half-angle from its middle,
/// x in [-1, 1] (0 hidden, 1 clear). The disc is a 3-ball of directions, and a plane cuts
/// (2 + 3x - x^3)/4 of a ball off, which is smoothstep((1 + x)/2).
double visible_part(double x);

/// The part of a light's disc that two covers or more leave clear, by 16 parallel lines through
/// it: of each, what no cover holds. Where the second cover only begins, the first one's flat rim
/// counts (visible_part), so that no edge is seen where a shadow begins in another's penumbra.
/// The order of the covers changes no bit.
/// Accuracy: 0.06 of the disc, mostly better than 0.015 (Overlap.OfBallsMatchesPoints).
double clear_part(std::span<const DiscCover> covers);

}  // namespace tesserae::render
