// SPDX-License-Identifier: Apache-2.0
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

void BoxPoints::clear() {
    count = 0;
    marks_.fill(Lanes::Constant(std::numeric_limits<double>::infinity()));
}

void BoxPoints::add_distinct(const Vec4& on_b, double separation, const BoxFace& face_a,
                             const BoxFace& face_b) {
    // Points in one place have the same mark within the tolerance, others hardly ever: the weights
    // keep apart what boxes with their edges along each other do not.
    const Vec4 weights{1, 0.7548776662, 0.5698402910, 0.4301597090};
    const double mark = weights.dot(on_b), tolerance = 4 * kBoxSlack;
    // All that a cell usually gives, whether there or not yet: the same loop every time.
    const std::size_t fours = std::max<std::size_t>(6, (static_cast<std::size_t>(count) + 3) / 4);
    Lanes nearest = (marks_[0] - mark).abs();
    for (std::size_t f = 1; f < fours; ++f) nearest = nearest.min((marks_[f] - mark).abs());
    if (nearest.minCoeff() <= 3 * tolerance)
        for (int i = 0; i < count; ++i)
            if ((point[i].on_b - on_b).cwiseAbs().maxCoeff() <= tolerance) return;
    marks_[count / 4][count % 4] = mark;
    point[count++] = {on_b, separation, face_a, face_b};
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
