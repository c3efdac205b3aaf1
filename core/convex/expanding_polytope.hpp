#pragma once

#include <array>
#include <cstdint>

#include "core/convex/minkowski_difference.hpp"

namespace tesserae {

/// The direction in which two bodies overlap least, as far as it is known.
struct LeastOverlap {
    Vec4 normal;   ///< unit, from a to b
    double depth;  ///< the support of the difference along it [units]
    /// Points of the difference of which a facet consists whose normal that is.
    std::array<DifferencePoint, 4> facet;
    bool is_exact;  ///< no direction has a smaller depth, to rounding
};

/// The face of a Minkowski difference nearest to the origin, which it holds: a polytope inside of
/// it, whose facets are tetrahedra, grows where it is nearest to the origin until it is at the
/// surface there (the expanding polytope algorithm, van den Bergen 2001; here in four dimensions
/// and as branch and bound: every support gives an upper bound, every facet a lower one, and a
/// facet that rounding does not let grow is passed over).
///
/// Polytopes: ends at the least overlap. Round bodies: ends when it is known to kRoundGap, or by
/// the bounds on vertices and facets, where many directions overlap almost alike.
/// @param start  5 points of the difference that span a simplex, which holds the origin or has it
///               on its boundary
LeastOverlap least_overlap(const MinkowskiDifference& difference,
                           const std::array<DifferencePoint, 5>& start);

}  // namespace tesserae
