// SPDX-License-Identifier: Apache-2.0
#include "core/shape/polychoron.hpp"

namespace tesserae {

void complete(Polychoron& shape) {
    std::vector<Vec4> points = shape.vertices;
    if (shape.regular != RegularPolychoron::kNone) {
        points = regular_vertices(shape.regular);
        for (Vec4& point : points) point *= shape.radius;
    }
    shape.body = std::make_shared<const HullBody>(hull_of(points));
}

}  // namespace tesserae
