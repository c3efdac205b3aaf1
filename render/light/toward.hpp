// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "core/shape/shape.hpp"
#include "render/sampling/cap.hpp"

// How to look at a body from outside it: random directions toward its surface, and how dense they
// are, so that what glows is a light that a surface can choose. In the body's frame.
namespace tesserae::render {

struct Toward {
    Vec4 direction;  ///< unit; may miss by rounding, and where only the bounding ball is known
    double density;  ///< [1/sr of S^3], > 0
};

/// A direction toward a bounded shape; none from inside it. Of a ball evenly in solid angle, of a
/// box and a capsule nearly so; of every other shape evenly over the cap of its bounding ball,
/// inside that evenly over half of all directions.
std::optional<Toward> sample_toward(const Shape& shape, const Vec4& origin, const Uniform3& u);

/// The density with which sample_toward() gives a direction that meets the shape; 0 from inside.
double density_toward(const Shape& shape, const Vec4& origin, const Vec4& direction);

}  // namespace tesserae::render
