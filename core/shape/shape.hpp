#pragma once

#include <variant>

#include "core/shape/hyperbox.hpp"
#include "core/shape/hypercapsule.hpp"
#include "core/shape/hyperplane.hpp"
#include "core/shape/hypersphere.hpp"

namespace tesserae {

/// The shape list: a new shape is its room, its pair files and one entry here. Code that works on
/// any shape visits it.
using Shape = std::variant<Hypersphere, Hypercapsule, Hyperbox, Hyperplane>;

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
