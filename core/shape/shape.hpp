#pragma once

#include <variant>

#include "core/shape/hyperbox.hpp"
#include "core/shape/hypercapsule.hpp"
#include "core/shape/hyperplane.hpp"
#include "core/shape/hypersphere.hpp"

namespace tesserae {

/// The shape itself; an error that names what is missing where its room is not complete.
template <ShapeRoom S>
using Complete = S;

/// The shape list: a new shape is its room, its pair files and one entry here. Code that works on
/// any shape visits it.
using Shape = std::variant<Complete<Hypersphere>, Complete<Hypercapsule>, Complete<Hyperbox>,
                           Complete<Hyperplane>>;

inline const char* name_of(const Shape& shape) {
    return std::visit([](const auto& s) { return s.kName; }, shape);
}
inline bool is_bounded(const Shape& shape) {
    return std::visit([](const auto& s) { return s.kBounded; }, shape);
}
/// Of the ball about the centre that holds it [m]; infinite if unbounded.
inline double bounding_radius(const Shape& shape) {
    return std::visit([](const auto& s) { return bounding_radius(s); }, shape);
}

}  // namespace tesserae
