// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shape/room.hpp"

namespace tesserae {

/// A Hyperplane is a half-space of the world: the side that the normal points to is free, the other
/// is solid. Its boundary is normal . p = offset.
struct Hyperplane {
    static constexpr const char* kName = "hyperplane";
    static constexpr bool kBounded = false;

    Vec4 normal = Vec4::UnitY();  ///< unit after complete(); before, any nonzero direction
    double offset = 0;            ///< [m], along the unit normal

    friend bool operator==(const Hyperplane&, const Hyperplane&) = default;
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        visit(
            {"normal", "",
             "The side that it points to is free, the other is solid; its length does not matter."},
            self.normal, Rule::kNonZero);
        visit({"offset", "m",
               "The plane is at the points p with normal . p = offset, for a normal of length 1."},
              self.offset, Rule::kFinite);
    }
};

/// Scales the normal to unit length.
void complete(Hyperplane&);
double volume(const Hyperplane& shape);
Vec4 second_moments(const Hyperplane& shape, double mass);
double bounding_radius(const Hyperplane& shape);
Vec4 half_extents(const Hyperplane& shape, const Mat4& rotation);
double half_extent_along(const Hyperplane& shape, const Vec4& direction);
Vec4 support(const Hyperplane& shape, const Vec4& direction);
Face face_along(const Hyperplane& shape, const Vec4& direction);
std::uint64_t faces_near(const Hyperplane& shape, const Vec4& point, double depth);
double signed_distance(const Hyperplane& shape, const Vec4& point);
Vec4 normal(const Hyperplane& shape, const Vec4& point);
double ray_hit(const Hyperplane& shape, const Vec4& origin, const Vec4& direction);
double ray_exit(const Hyperplane& shape, const Vec4& origin, const Vec4& direction);
Rim rim(const Hyperplane& shape, const Vec4& origin, const Vec4& direction, const RimRange& range);

}  // namespace tesserae
