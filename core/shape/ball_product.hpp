// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "core/shape/room.hpp"

namespace tesserae {

/// A BallFactor is a ball over some of the axes: a segment, a disc or a three-dimensional ball.
struct BallFactor {
    Vec4 axes = Vec4::Zero();  ///< 1 for the axes of the ball, else 0
    int dimensions = 0;
    double radius = 0;  ///< [m]
};

/// A BallProduct is the product of balls that share out the axes. A point is inside if its part
/// along every factor's axes lies in that factor's ball. Spherinder, cubinder and duocylinder each
/// are one; their rooms make it.
struct BallProduct {
    std::array<BallFactor, 3> factor;
    std::size_t factors = 0;

    void clear() { factors = 0; }
    /// Adds a factor.
    /// @param axes   1 for the axes of the ball, else 0
    void add(const Vec4& axes, double radius) {
        factor[factors++] = {axes, static_cast<int>(axes.sum()), radius};
    }
    const BallFactor* begin() const { return factor.data(); }
    const BallFactor* end() const { return factor.data() + factors; }
};

double volume(const BallProduct& shape);
Vec4 second_moments(const BallProduct& shape, double mass);
double bounding_radius(const BallProduct& shape);
Vec4 half_extents(const BallProduct& shape, const Mat4& rotation);
double half_extent_along(const BallProduct& shape, const Vec4& direction);
Vec4 support(const BallProduct& shape, const Vec4& direction);
double signed_distance(const BallProduct& shape, const Vec4& point);
Vec4 normal(const BallProduct& shape, const Vec4& point);
double ray_hit(const BallProduct& shape, const Vec4& origin, const Vec4& direction);
double ray_exit(const BallProduct& shape, const Vec4& origin, const Vec4& direction);
Rim rim(const BallProduct& shape, const Vec4& origin, const Vec4& direction, const RimRange& range);

/// Returns the point of a factor's ball that is farthest along the direction. Where the direction
/// has no part along the factor's axes, it is the end of the first axis.
Vec4 support(const BallFactor& factor, const Vec4& direction);

}  // namespace tesserae
