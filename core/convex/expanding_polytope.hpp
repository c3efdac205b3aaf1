// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/convex/convex_separation.hpp"
#include "core/convex/minkowski_difference.hpp"

namespace tesserae {

/// A LeastOverlap is the direction in which two bodies overlap least, as far as it is known.
struct LeastOverlap {
    Vec4 normal;   ///< unit, from a to b
    double depth;  ///< the overlap along it: the support of the difference [units]
    /// The points of the difference that span a facet with that normal.
    std::array<DifferencePoint, 4> facet;
    bool is_exact;  ///< no direction has a smaller depth, to rounding
};

/// Finds the face nearest to the origin of a Minkowski difference that contains the origin. A
/// polytope inside the difference, whose facets are tetrahedra, grows where it is nearest to the
/// origin until it is at the surface there. This is the expanding polytope algorithm (van den
/// Bergen 2001), here in four dimensions and as branch and bound: every support gives an upper
/// bound, every facet a lower one. A facet that cannot grow because of rounding is skipped.
///
/// For polytopes it ends at the least overlap. For round bodies it ends when the overlap is known
/// to kRoundGap, or at the limits on vertices and facets if many directions overlap almost alike.
/// @param start   5 points of the difference that span a simplex, which has the origin inside or on
///                its boundary
/// @param takes   is offered the direction once the gap between the bounds is small
/// @return nothing if the direction was taken
std::optional<LeastOverlap> least_overlap(const MinkowskiDifference& difference,
                                          const std::array<DifferencePoint, 5>& start,
                                          const TakesDirection& takes);

}  // namespace tesserae
