// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shape/room.hpp"

namespace tesserae {

/// A Hypercapsule is all points within `radius` of its core, a segment of length `height` about the
/// centre along the body's y axis.
struct Hypercapsule {
    static constexpr const char* kName = "hypercapsule";
    static constexpr bool kBounded = true;

    double radius = 1;  ///< [m], > 0
    double height = 1;  ///< length of the core [m], >= 0; 0 is a hypersphere

    friend bool operator==(const Hypercapsule&, const Hypercapsule&) = default;
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        visit({"radius", "m", "The surface is this far from the core."}, self.radius,
              Rule::kPositive);
        visit({"height", "m",
               "The core is a segment of this length along y; the whole capsule is longer by twice "
               "the radius."},
              self.height, Rule::kNonNegative);
    }
};

inline void complete(Hypercapsule&) {}
double volume(const Hypercapsule& shape);
Vec4 second_moments(const Hypercapsule& shape, double mass);
double bounding_radius(const Hypercapsule& shape);
Vec4 half_extents(const Hypercapsule& shape, const Mat4& rotation);
double half_extent_along(const Hypercapsule& shape, const Vec4& direction);
Vec4 support(const Hypercapsule& shape, const Vec4& direction);
double signed_distance(const Hypercapsule& shape, const Vec4& point);
Vec4 normal(const Hypercapsule& shape, const Vec4& point);
double ray_hit(const Hypercapsule& shape, const Vec4& origin, const Vec4& direction);
double ray_exit(const Hypercapsule& shape, const Vec4& origin, const Vec4& direction);
Rim rim(const Hypercapsule& shape, const Vec4& origin, const Vec4& direction,
        const RimRange& range);

}  // namespace tesserae
