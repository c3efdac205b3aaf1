// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "core/shape/cubinder.hpp"
#include "core/shape/duocylinder.hpp"
#include "core/shape/duoprism.hpp"
#include "core/shape/hyperbox.hpp"
#include "core/shape/hypercapsule.hpp"
#include "core/shape/hyperplane.hpp"
#include "core/shape/hypersphere.hpp"
#include "core/shape/polychoron.hpp"
#include "core/shape/spherinder.hpp"

namespace tesserae {

/// Complete<S> is the shape S itself. If its room is not complete, the compiler names what is
/// missing.
template <ShapeRoom S>
using Complete = S;

/// A Shape is any one of the shapes. A new shape is its room, its pair files and one entry in this
/// list. Code that works on any shape visits it.
using Shape = std::variant<Complete<Hypersphere>, Complete<Hypercapsule>, Complete<Hyperbox>,
                           Complete<Hyperplane>, Complete<Polychoron>, Complete<Duoprism>,
                           Complete<Spherinder>, Complete<Cubinder>, Complete<Duocylinder>>;

inline const char* name_of(const Shape& shape) {
    return std::visit([](const auto& s) { return s.kName; }, shape);
}
inline bool is_bounded(const Shape& shape) {
    return std::visit([](const auto& s) { return s.kBounded; }, shape);
}
/// Returns the radius of the ball about the centre that holds the shape [m]; infinite if unbounded.
inline double bounding_radius(const Shape& shape) {
    return std::visit([](const auto& s) { return bounding_radius(s); }, shape);
}

/// Returns the unit outward normal at a point of the surface, in the shape's frame. Pictures are
/// shaded with it.
inline Vec4 surface_normal(const Shape& shape, const Vec4& point) {
    return std::visit(
        [&]<class S>(const S& s) -> Vec4 {
            if constexpr (HasShadingNormal<S>)
                return shading_normal(s, point);
            else
                return normal(s, point);
        },
        shape);
}
/// Returns the rotor from the principal axes to the body's axes, or null if they are the same.
inline const Rotor* principal_axes_of(const Shape& shape) {
    return std::visit(
        []<class S>(const S& s) -> const Rotor* {
            if constexpr (HasPrincipalAxes<S>)
                return principal_axes(s);
            else
                return nullptr;
        },
        shape);
}

}  // namespace tesserae
