// SPDX-License-Identifier: Apache-2.0
#include "core/shape/duoprism.hpp"

#include <cmath>

#include "core/error.hpp"

namespace tesserae {
namespace {

/// The vertices of a regular polygon; right angles exact.
std::vector<Vec2> polygon(std::int64_t sides, double radius) {
    std::vector<Vec2> corners;
    for (std::int64_t i = 0; i < sides; ++i) {
        const std::int64_t quarter = 4 * i / sides;
        const double angle = 2 * M_PI * static_cast<double>(4 * i - quarter * sides) /
                             static_cast<double>(4 * sides);
        const Vec2 v(radius * std::cos(angle), radius * std::sin(angle));
        const Vec2 turned[] = {v, {-v[1], v[0]}, -v, {v[1], -v[0]}};
        corners.push_back(turned[quarter]);
    }
    return corners;
}

}  // namespace

void complete(Duoprism& shape) {
    if (shape.polygons[0] * shape.polygons[1] > Duoprism::kMostVertices)
        throw InputError(fmt::format("{} vertices; expected at most {}: the product of the sides",
                                     shape.polygons[0] * shape.polygons[1],
                                     Duoprism::kMostVertices));
    std::vector<Vec4> points;
    for (const Vec2& first : polygon(shape.polygons[0], shape.radii[0]))
        for (const Vec2& second : polygon(shape.polygons[1], shape.radii[1]))
            points.push_back({first[0], first[1], second[0], second[1]});
    shape.body = std::make_shared<const HullBody>(hull_of(points));
}

}  // namespace tesserae
