// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <span>

#include "core/algebra/vector.hpp"
#include "core/function_ref.hpp"

namespace tesserae {

/// A Support is a function that returns a convex body's farthest point along a direction (any
/// length, not zero). The point is relative to a common origin of both bodies [m]. Rounding is
/// relative to the coordinates: an origin in or near the bodies serves best.
using Support = FunctionRef<Vec4(const Vec4&)>;

/// A ConvexSeparation says how far two convex bodies are apart, or how deep they overlap.
struct ConvexSeparation {
    Vec4 normal;      ///< unit, from a to b
    double distance;  ///< along the normal [m]; minus the least overlap if they overlap
    Vec4 on_a, on_b;  ///< nearest points while apart, deepest ones in overlap [m]
};

/// The error of the distance of polytopes is at most this, relative to the size and the points'
/// coordinates, if the supports are as accurate. The tests use this number.
constexpr double kConvexAccuracy = 1e-14;
/// This is the error bound for round bodies that lie apart. For bodies with a core it is better to
/// widen the separation of the cores, see widened().
constexpr double kRoundAccuracy = 1e-12;
/// This is the error bound for round bodies in overlap. The overlap that is returned is a true one
/// along its normal, but it may exceed the least by this. Most are within kRoundAccuracy. Of the
/// others, mostly sunk deeply, the deepest points may lie off the surfaces by more than this. Cores
/// have neither fault.
constexpr double kRoundOverlapAccuracy = 1e-3;

/// Returns the separation of two convex bodies that are known by their supports alone: polytopes,
/// round bodies, flat ones, segments and points. It is the greatest gap along any unit n, which is
/// -h(n), where h is the support function of the Minkowski difference a - b. So the distance that
/// is returned is always a true gap, or overlap, along the normal that is returned.
/// @param guess    any nonzero direction from a to b (for example between the centres)
/// @param size     a length of the order of both bodies (sum of bounding radii) [m]; tolerances are
///                 relative to it
/// @param enough   for bodies that are farther apart than this [m], any gap above it may be
///                 returned; most such answers take two or three steps
///
/// If one body is sunk to the other's middle there are several least overlaps; which one is
/// returned depends on rounding. No finite input gives a NaN.
///
/// Sources: Gilbert, Johnson, Keerthi 1988 for bodies apart, with the nearest point of a simplex
/// after Wolfe 1976 (see Simplex); van den Bergen 2001 for the overlap (see ExpandingPolytope).
ConvexSeparation separation_of(const Support& a, const Support& b, const Vec4& guess, double size,
                               double enough = std::numeric_limits<double>::infinity());

/// A VertexPair is a point of each of two bodies, each a farthest one along some direction.
struct VertexPair {
    Vec4 on_a, on_b;
};
/// Returns the separation, starting from points of both bodies that are known to be near the
/// result. Any points will do, but better ones leave less work.
/// @param first   1 to 5 pairs, as the supports return them; it is best to put the heaviest first
ConvexSeparation separation_of(const Support& a, const Support& b,
                               std::span<const VertexPair> first, double size,
                               double enough = std::numeric_limits<double>::infinity());

/// Takes about the normal along which two bodies overlap least, if it knows the separation from
/// there on. Returns whether it does.
using TakesDirection = FunctionRef<bool(const Vec4&)>;
/// Returns the separation of two bodies. If they overlap, about the normal is offered as soon as it
/// is known: what leads from there to the normal itself takes most of the time.
/// @return nothing if the direction was taken
std::optional<ConvexSeparation> separation_unless(const Support& a, const Support& b,
                                                  const Vec4& guess, double size,
                                                  const TakesDirection& takes);

/// Returns the separation of two bodies that are all points within a radius of two convex cores,
/// from the separation of the cores. The support function of a ball is the same in all directions,
/// so the normal is the same. Spheres are points and capsules are segments, and nothing of their
/// roundness needs to be approximated.
inline ConvexSeparation widened(const ConvexSeparation& cores, double radius_a, double radius_b) {
    return {cores.normal, cores.distance - (radius_a + radius_b),
            cores.on_a + radius_a * cores.normal, cores.on_b - radius_b * cores.normal};
}

}  // namespace tesserae
