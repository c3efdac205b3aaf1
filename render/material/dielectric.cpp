// SPDX-License-Identifier: Apache-2.0
#include "render/material/dielectric.hpp"

#include <algorithm>
#include <cmath>

namespace tesserae::render {

Vec4 reflected(const Vec4& direction, const Vec4& normal) {
    return (direction - 2 * std::min(0.0, direction.dot(normal)) * normal).normalized();
}

std::optional<Vec4> refracted(const Vec4& direction, const Vec4& normal, double ratio) {
    const double cosine = std::clamp(-direction.dot(normal), 0.0, 1.0);
    const double square = 1 - ratio * ratio * (1 - cosine) * (1 + cosine);
    if (!(square > 0)) return std::nullopt;
    return (ratio * direction + (ratio * cosine - std::sqrt(square)) * normal).normalized();
}

double fresnel(double cosine, double ratio) {
    const double square = 1 - ratio * ratio * (1 - cosine) * (1 + cosine);
    if (!(square > 0)) return 1;
    const double beyond = std::sqrt(square);
    const double s = (ratio * cosine - beyond) / (ratio * cosine + beyond);
    const double p = (cosine - ratio * beyond) / (cosine + ratio * beyond);
    return (p * p + 2 * s * s) / 3;
}

}  // namespace tesserae::render
