// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/convex/convex_separation.hpp"
#include "core/convex/linear_forms.hpp"

namespace tesserae {

/// A PlacedHull is a polytope at a place, given by its vertices.
struct PlacedHull {
    const std::vector<Vec4>& vertices;
    const LinearForms& corners;  ///< x . vertex, of all vertices in their order
    Mat4 turn;                   ///< rotation from the body's frame
    Vec4 centre;                 ///< [m]
};

/// Returns a farthest vertex along a direction.
Vec4 support(const PlacedHull& body, const Vec4& direction);

/// Returns the separation that the supports of the bodies would give, to the same accuracy (see
/// convex_separation.hpp). It first finds, in the frame of a and to fewer digits, the vertices that
/// the nearest points lie between.
ConvexSeparation separation_of(const PlacedHull& a, const PlacedHull& b, const Vec4& guess,
                               double size,
                               double enough = std::numeric_limits<double>::infinity());

}  // namespace tesserae
