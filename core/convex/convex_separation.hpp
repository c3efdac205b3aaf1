#pragma once

#include <limits>
#include <span>

#include "core/algebra/vector.hpp"
#include "core/function_ref.hpp"

namespace tesserae {

/// A convex body's farthest point along a direction (any length, not zero), relative to any common
/// origin [m]. Rounding is relative to the coordinates: an origin in or near the bodies serves
/// best.
using Support = FunctionRef<Vec4(const Vec4&)>;

/// How far two convex bodies are apart, or how deep they overlap.
struct ConvexSeparation {
    Vec4 normal;      ///< unit, from a to b
    double distance;  ///< along it [m]; negative: the least overlap
    Vec4 on_a, on_b;  ///< nearest points while apart, deepest ones in overlap [m]
};

/// Error bound of the distance of polytopes, relative to the size and the points' coordinates, for
/// supports that are as good. Tested as it stands.
constexpr double kConvexAccuracy = 1e-14;
/// The same for bodies that are round, while they are apart; better widen cores where there are
/// some.
constexpr double kRoundAccuracy = 1e-12;
/// The same for round bodies in overlap: it may be larger than the least by so much, and is a true
/// one along its normal. Nine in ten are within kRoundAccuracy; of the others, mostly sunk deeply,
/// the deepest points may lie off the surfaces by more than this. Cores have neither fault.
constexpr double kRoundOverlapAccuracy = 1e-3;

/// The separation of two convex bodies that are known by their supports alone: polytopes, round
/// bodies, flat ones, segments and points. It is the greatest over all unit n of the gap along n,
/// -h(n), where h is the support function of the Minkowski difference a - b; so the distance that
/// is returned is always a true gap, or overlap, along the normal that is returned.
/// @param guess  nonzero direction from a to b, any (for example between the centres)
/// @param size   a length of the order of both bodies (sum of bounding radii) [m]: tolerances are
///               relative to it
/// @param enough bodies that are farther apart than this [m] may be said to be apart by any gap
///               above it: most are told so in two or three steps
///
/// Bodies of which one is sunk to the other's middle have several least overlaps; which one is
/// returned depends on rounding. No finite input gives a NaN.
///
/// Sources: Gilbert, Johnson, Keerthi 1988 for what is apart, with the nearest point of a simplex
/// after Wolfe 1976 (see Simplex); van den Bergen 2001 for the overlap (see ExpandingPolytope).
ConvexSeparation separation_of(const Support& a, const Support& b, const Vec4& guess, double size,
                               double enough = std::numeric_limits<double>::infinity());

/// A point of each of two bodies, a farthest one along some direction.
struct VertexPair {
    Vec4 on_a, on_b;
};
/// The same from points of both bodies that are known to be near the end. The better they are the
/// less is left to do; any will do.
/// @param first   1 to 5 pairs, as the supports return them; the heaviest best comes first
ConvexSeparation separation_of(const Support& a, const Support& b,
                               std::span<const VertexPair> first, double size,
                               double enough = std::numeric_limits<double>::infinity());

/// The separation of the bodies that are all within a radius of two convex cores, of which it is
/// known. The support functions of balls are the same in all directions, so it has the same normal:
/// spheres are points, capsules segments, and nothing of their roundness is left to approximate.
inline ConvexSeparation widened(const ConvexSeparation& cores, double radius_a, double radius_b) {
    return {cores.normal, cores.distance - (radius_a + radius_b),
            cores.on_a + radius_a * cores.normal, cores.on_b - radius_b * cores.normal};
}

}  // namespace tesserae
