// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "core/convex/convex_separation.hpp"

namespace tesserae {

/// A DifferencePoint is a point of the difference and the point of a that it comes from. The point
/// of b is on_a - at.
struct DifferencePoint {
    Vec4 at, on_a;
};

/// A MinkowskiDifference is the set a - b of two bodies: all x - y with x in a and y in b. It uses
/// units in which both are about 1 large, so that squares and cubes of lengths neither overflow nor
/// vanish.
class MinkowskiDifference {
  public:
    MinkowskiDifference(const Support& a, const Support& b, double size)
        : a_(a),
          b_(b),
          // A power of two rounds nothing.
          unit_(size > 0 && std::isfinite(size) ? std::ldexp(1.0, std::ilogb(size)) : 1),
          to_units_(1 / unit_) {}

    /// Returns the farthest point along a direction.
    DifferencePoint support(const Vec4& direction) const {
        return point_of({a_(direction), b_(-direction)});
    }
    /// Returns the point of the difference that a pair of vertices makes.
    DifferencePoint point_of(const VertexPair& pair) const {
        const Vec4 on_a = to_units_ * pair.on_a, on_b = to_units_ * pair.on_b;
        return {on_a - on_b, on_a};
    }
    /// Returns the length of the unit [m].
    double unit() const { return unit_; }
    /// Returns the length below which a length is rounding [units].
    double rounding() const { return rounding_; }
    /// Raises rounding() to suit the size of a point's coordinates.
    void note_coordinates(const DifferencePoint& p) {
        const double largest = std::max(p.on_a.cwiseAbs().maxCoeff(), p.at.cwiseAbs().maxCoeff());
        rounding_ = std::max(rounding_, kRounding * largest);
    }

  private:
    /// A coordinate of 1 [units] is rounded by this, usual 4e-16: two units in the last place. The
    /// tolerances are multiples of it. Less, and loops end only by lack of progress; more, and the
    /// error of the result is as much.
    static constexpr double kRounding = 4e-16;

    const Support& a_;
    const Support& b_;
    double unit_, to_units_;
    double rounding_ = kRounding;
};

}  // namespace tesserae
