// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shape/room.hpp"

namespace tesserae {

/// A Hypersphere is all points within `radius` of the centre.
struct Hypersphere {
    static constexpr const char* kName = "hypersphere";
    static constexpr bool kBounded = true;

    double radius = 1;  ///< [m], > 0

    friend bool operator==(const Hypersphere&, const Hypersphere&) = default;
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        visit({"radius", "m", "The surface is this far from the centre."}, self.radius,
              Rule::kPositive);
    }
};

inline void complete(Hypersphere&) {}
double volume(const Hypersphere& shape);
Vec4 second_moments(const Hypersphere& shape, double mass);
double bounding_radius(const Hypersphere& shape);
Vec4 half_extents(const Hypersphere& shape, const Mat4& rotation);
double half_extent_along(const Hypersphere& shape, const Vec4& direction);
Vec4 support(const Hypersphere& shape, const Vec4& direction);
double signed_distance(const Hypersphere& shape, const Vec4& point);
Vec4 normal(const Hypersphere& shape, const Vec4& point);
double ray_hit(const Hypersphere& shape, const Vec4& origin, const Vec4& direction);
double ray_exit(const Hypersphere& shape, const Vec4& origin, const Vec4& direction);
Rim rim(const Hypersphere& shape, const Vec4& origin, const Vec4& direction, const RimRange& range);

/// A BallRim is the least f(t)/t of a ball along a ray from outside (see Rim), and the distance [m]
/// at which it is met. The least is 1, at infinity, where the ball lies behind.
struct BallRim {
    double sine, distance;
};
/// Returns the rim of a ball about the origin of coordinates.
/// @param square   |origin|^2, at least radius^2; see is_plain_square()
BallRim ball_rim(double radius, const Vec4& origin, double square, const Vec4& direction);

}  // namespace tesserae
