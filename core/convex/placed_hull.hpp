#pragma once

#include <vector>

#include "core/convex/convex_separation.hpp"
#include "core/convex/linear_forms.hpp"

namespace tesserae {

/// A polytope somewhere, by its vertices.
struct PlacedHull {
    const std::vector<Vec4>& vertices;
    const LinearForms& corners;  ///< x . vertex, of all of them in their order
    Mat4 turn;                   ///< rotation from the body's frame
    Vec4 centre;                 ///< [m]
};

/// A farthest vertex along a direction.
Vec4 support(const PlacedHull& body, const Vec4& direction);

/// What separation_of() says of their supports, to the same accuracy. Which vertices the nearest
/// points are between is found first, in the frame of a and to fewer digits.
ConvexSeparation separation_of(const PlacedHull& a, const PlacedHull& b, const Vec4& guess,
                               double size,
                               double enough = std::numeric_limits<double>::infinity());

}  // namespace tesserae
