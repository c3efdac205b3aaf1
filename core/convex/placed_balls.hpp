#pragma once

#include <array>
#include <cstdint>

#include "core/convex/convex_separation.hpp"

namespace tesserae {

/// A convex body that is a product of balls along its axes: each axis belongs to a group, and the
/// coordinates of a group are a ball. Three axes and one are a spherinder, two and two single ones
/// a cubinder, two and two a duocylinder, four single ones a box; with radii of 0, segments and
/// points.
struct PlacedBalls {
    std::array<std::uint8_t, 4> group;  ///< of each axis, 0 to 3
    Vec4 radius;                        ///< of group 0, 1, 2, 3 [m], >= 0; of no group: any
    Mat4 turn;                          ///< rotation from the body's frame
    Vec4 centre;                        ///< [m]
};

/// A farthest point along a direction; of a group that is orthogonal to it, one on the rim.
Vec4 support(const PlacedBalls& body, const Vec4& direction);

/// Error bound of the distance between products of balls, relative to the sum of their bounding
/// radii and the distance of their centres. In overlap it is a local least one to this bound,
/// while it is shallow (kShallowOverlap) and less than the bodies' radii; deeper, one in a thousand
/// may be larger than that by kRoundOverlapAccuracy. It is a true gap along its normal in all
/// cases.
constexpr double kPlacedBallsAccuracy = 1e-13;
/// Overlaps to this part of the sum of the bounding radii are shallow.
constexpr double kShallowOverlap = 1.0 / 32;
/// Error bound of the normal of bodies that are apart, times the part that their distance has in
/// the sum of it and the bounding radii.
constexpr double kPlacedBallsNormalAccuracy = 1e-10;
/// Bound of how far the points are off the surfaces along the normal, relative in the same way.
/// Of one in ten thousand overlaps deeper than a body is thick it may be kRoundOverlapAccuracy.
constexpr double kPlacedBallsPointAccuracy = 1e-11;

/// The separation of two products of balls, apart or in overlap. Where a face of one lies on one of
/// the other, the points are about the middle of what they share.
///
/// The support function of a group is r |u|, where u is the normal's part in the group; with
/// r sqrt(|u|^2 + mu^2) for it the gap is smooth, and its slopes are the points. Newton's method
/// goes to the normal and the points at once while mu falls to 1e-13, so that a group that is
/// orthogonal to the normal is no obstacle: see Chan, Golub and Mulet 1999, whose linearisation it
/// is, there for total variation. It takes some 8 steps. Where that fails (three shallow overlaps
/// in a thousand, most of them where edges touch edges) the general method finds a start.
ConvexSeparation separation_of(const PlacedBalls& a, const PlacedBalls& b);

}  // namespace tesserae
