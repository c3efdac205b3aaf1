// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/shape/room.hpp"

namespace tesserae {

/// A Hyperbox is a box about the centre, with its sides along the body's axes.
struct Hyperbox {
    static constexpr const char* kName = "hyperbox";
    static constexpr bool kBounded = true;

    Vec4 size = Vec4::Ones();  ///< four full sides [m], > 0

    friend bool operator==(const Hyperbox&, const Hyperbox&) = default;
    template <class Self, class Visit>
    static void parameters(Self& self, Visit&& visit) {
        visit({"size", "m", "The box has these full sides along x, y, z and w."}, self.size,
              Rule::kPositive);
    }
};

inline void complete(Hyperbox&) {}
double volume(const Hyperbox& shape);
Vec4 second_moments(const Hyperbox& shape, double mass);
double bounding_radius(const Hyperbox& shape);
Vec4 half_extents(const Hyperbox& shape, const Mat4& rotation);
double half_extent_along(const Hyperbox& shape, const Vec4& direction);
Vec4 support(const Hyperbox& shape, const Vec4& direction);
bool is_face_normal(const Hyperbox& shape, const Vec4& direction);
Face face_along(const Hyperbox& shape, const Vec4& direction);
std::uint64_t faces_near(const Hyperbox& shape, const Vec4& point, double depth);
double signed_distance(const Hyperbox& shape, const Vec4& point);
Vec4 normal(const Hyperbox& shape, const Vec4& point);
double ray_hit(const Hyperbox& shape, const Vec4& origin, const Vec4& direction);
double ray_exit(const Hyperbox& shape, const Vec4& origin, const Vec4& direction);
Rim rim(const Hyperbox& shape, const Vec4& origin, const Vec4& direction, const RimRange& range);

}  // namespace tesserae
