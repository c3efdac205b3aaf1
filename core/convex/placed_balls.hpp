// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/convex/convex_separation.hpp"

namespace tesserae {

/// A PlacedBalls is a product of balls at a place. Each axis of the body belongs to a group, and
/// the coordinates of a group are in a ball. Three axes and one are a spherinder, two and two
/// single ones a cubinder, two and two a duocylinder, four single ones a box. With radii of 0 there
/// are also segments and points.
struct PlacedBalls {
    std::array<std::uint8_t, 4> group;  ///< the group of each axis, 0 to 3
    Vec4 radius;  ///< of groups 0 to 3 [m], >= 0; any value for an unused group
    Mat4 turn;    ///< rotation from the body's frame
    Vec4 centre;  ///< [m]
};

/// Returns a farthest point along a direction. For a group that is orthogonal to the direction it
/// is a point on the rim.
Vec4 support(const PlacedBalls& body, const Vec4& direction);

/// The error of the distance between products of balls is at most this, relative to the sum of
/// their bounding radii and the distance of their centres. A shallow overlap (kShallowOverlap) that
/// is less than the bodies' radii is a local minimum to this bound. A deeper one may, rarely, be
/// larger than that by kRoundOverlapAccuracy. The distance is a true gap along its normal in all
/// cases.
constexpr double kPlacedBallsAccuracy = 1e-13;
/// Overlaps up to this part of the sum of the bounding radii are shallow.
constexpr double kShallowOverlap = 1.0 / 32;
/// The error of the normal of bodies that lie apart is at most this, times the share of their
/// distance in the sum of it and the bounding radii.
constexpr double kPlacedBallsNormalAccuracy = 1e-10;
/// The points are off the surfaces along the normal by at most this, relative in the same way as
/// kPlacedBallsAccuracy. In rare overlaps deeper than a body is thick it may be
/// kRoundOverlapAccuracy.
constexpr double kPlacedBallsPointAccuracy = 1e-11;

/// Returns the separation of two products of balls, apart or in overlap. If a face of one lies on a
/// face of the other, the points are about the middle of the area that they share.
///
/// The support function of a group is r |u|, where u is the part of the normal in the group. With r
/// sqrt(|u|^2 + mu^2) in its place the gap is smooth, and its gradients are the points. Newton's
/// method finds the normal and the points together while mu falls to 1e-13, so that a group
/// orthogonal to the normal is no obstacle. The linearisation is that of Chan, Golub and Mulet
/// 1999, who use it for total variation. It takes some 8 steps. If it fails, as in a few shallow
/// overlaps, most of them of edges with edges, the general method finds a start.
ConvexSeparation separation_of(const PlacedBalls& a, const PlacedBalls& b);

}  // namespace tesserae
