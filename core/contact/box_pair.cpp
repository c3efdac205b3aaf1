#include "core/contact/box_pair.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace tesserae {

BoxPair box_pair(const Hyperbox& a, const Vec4& position_a, const Mat4& axes_a, const Hyperbox& b,
                 const Vec4& position_b, const Mat4& axes_b) {
    BoxPair pair;
    const double largest = 0.5 * std::max(a.size.maxCoeff(), b.size.maxCoeff());
    pair.unit = std::ldexp(1.0, std::clamp(std::ilogb(largest), -1000, 1000));
    const double scale = 1 / pair.unit;
    pair.half_a = (0.5 * scale) * a.size;
    pair.half_b = (0.5 * scale) * b.size;
    pair.offset = scale * (axes_a.transpose() * (position_b - position_a));
    pair.rotation = axes_a.transpose() * axes_b;
    return pair;
}

BoxPair swapped(const BoxPair& pair) {
    BoxPair other;
    other.half_a = pair.half_b;
    other.half_b = pair.half_a;
    other.rotation = pair.rotation.transpose();
    other.offset = -(other.rotation * pair.offset);
    other.unit = pair.unit;
    return other;
}

void BoxPoints::add_distinct(const BoxPoint& candidate) {
    for (int i = 0; i < count; ++i) {
        const Vec4 between = point[i].on_b - candidate.on_b;
        if (between.cwiseAbs().maxCoeff() <= 4 * kBoxSlack) return;
    }
    point[count++] = candidate;
}

void BoxPoints::swap_boxes(const BoxPair& pair) {
    for (int i = 0; i < count; ++i) {
        BoxPoint& p = point[i];
        p.on_b = pair.rotation.transpose() * (p.on_b - p.separation * normal - pair.offset);
        std::swap(p.face_a, p.face_b);
    }
    normal = -(pair.rotation.transpose() * normal);
}

double BoxPoints::least_separation() const {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < count; ++i) least = std::min(least, point[i].separation);
    return least;
}

}  // namespace tesserae
